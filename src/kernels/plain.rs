//! The hot functions in their plain form, as the shaders have them.

use crate::env::workgroup::HotForms;

/// The twins themselves.
pub const PLAIN: HotForms = HotForms {
    draw_step: |group, stream| group.random.draw_step(stream),
    observe: |group, x, y, heading, bumpers, noise| group.observe(x, y, heading, bumpers, noise),
    move_body: |group, x, y, heading, action, slip| group.move_body(x, y, heading, action, slip),
    encode: |group, skill, mirrored| group.encode(skill, mirrored),
    forward: |group, skill| group.forward(skill),
    boltzmann: |group, children, allowed, inverse_temperature| group.boltzmann(children, allowed, inverse_temperature),
    backward: |group, skill, child, delta, step_size| group.backward(skill, child, delta, step_size),
};
