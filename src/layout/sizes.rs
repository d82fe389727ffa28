//! Sizes that both languages share.

constants! {
    /// Invocations of a workgroup; elements of every lane array.
    LANES = 32;
    /// Sonar and light bearings, 15 degrees apart.
    RAYS = 24;
    /// Most children of a skill.
    MAX_CHILDREN = 8;
    /// Most inputs of a net.
    MAX_INPUTS = 64;
    /// Most rows of weights of a net, in whole lane arrays: inputs, outputs and two of biases.
    MAX_ROWS = 96;
    /// Most input groups of a skill.
    MAX_GROUPS = 12;
    /// Most segments of a world.
    MAX_SEGMENTS = 256;
    /// Most rooms of a world.
    MAX_ROOMS = 16;
    /// Most doors of a world.
    MAX_DOORS = 16;
    /// Most start regions of a skill.
    MAX_STARTS = 4;
    /// Most skills of a learner.
    MAX_SKILLS = 8;
    /// Most skills between the root of a tree and an action, the root counted.
    MAX_DEPTH = 6;
    /// Code of a skill's first skill as a child; lower codes are actions.
    SKILL_CODE = 16;
    /// Words of an observation that hold the sonar's readings.
    SONAR_WORDS = RAYS / 4;
    /// Bit of `light_bumpers` from which the bumpers stand.
    BUMPERS_FROM = 24;
    /// Entries of a sonar coding table.
    SONAR_CODES = 128;
}
