//! One learner's memory without a backend, and workgroups that act on it: as the shaders have them, and in the CPU's way.

use super::configs::number;
use super::lessons::Lesson;
use skilltree::backend::cpu::CPU;
use skilltree::config::plan::Plan;
use skilltree::env::segments::SegmentGrid;
use skilltree::env::workgroup::{CohortData, HotForms, Nets, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{
    HyperParams, LANES, LESSON_HEADER_WORDS, LearnerState, LessonHeader, STEP_WORDS, SkillShape, Step,
};
use skilltree::train::allocate::Shape;
use std::fmt::Debug;

/// The hot functions in their plain form and in the CPU's.
pub(crate) const FORMS: [&HotForms; 2] = [&PLAIN, &CPU.hot];

/// What a workgroup finds that has one skill's nets to read, or none. Both forms must find the same.
#[track_caller]
pub(crate) fn seen<T: PartialEq + Debug>(
    shared: &CohortData,
    params: &[HyperParams],
    nets: &[f32],
    look: impl Fn(&mut Workgroup<'_>) -> T,
) -> T {
    let in_form = |forms| look(&mut Workgroup { nets: Nets::Read(nets), ..Workgroup::new(shared, params, forms) });
    let [plain, tuned] = FORMS.map(in_form);
    assert_eq!(plain, tuned, "the tuned form finds something else");
    plain
}

/// One learner of a plan's first arm, without a bank.
#[derive(Clone)]
pub(crate) struct Learner {
    pub(crate) plan: Plan,
    pub(crate) shared: CohortData,
    pub(crate) params: Vec<HyperParams>,
    pub(crate) state: LearnerState,
    pub(crate) nets: Vec<f32>,
    pub(crate) lessons: Vec<u32>,
}

impl Learner {
    pub(crate) fn new(plan: Plan) -> Self {
        let shape = Shape::new(plan.world(), &[&plan.arms[0]]).expect("the skills fit");
        let (params, state, nets) = shape.learner(&plan.arms[0], plan.run_seed, 0);
        let floor = SegmentGrid::new(&shape.tables.plan, &shape.tables.words);
        let lessons = vec![0; shape.lessons_stride];
        let shared = CohortData { floor, skills: shape.skills, tables: shape.tables.words, bank: vec![0] };
        Self { plan, shared, params, state, nets, lessons }
    }

    /// Number of the skill of this name.
    pub(crate) fn skill(&self, name: &str) -> usize {
        number(&self.plan, name)
    }

    /// What a workgroup finds that only looks. Both forms must find the same.
    #[track_caller]
    pub(crate) fn seen<T: PartialEq + Debug>(&self, look: impl Fn(&mut Workgroup<'_>) -> T) -> T {
        seen(&self.shared, &self.params, &self.nets, |group| {
            group.state = self.state;
            look(group)
        })
    }

    /// Lets a workgroup work on the learner's nets and state, in both forms, which must leave the same bytes. Lessons
    /// are there to be read.
    #[track_caller]
    pub(crate) fn act<T: PartialEq + Debug>(&mut self, act: impl Fn(&mut Workgroup<'_>) -> T) -> T {
        let [plain, tuned] = FORMS.map(|forms| {
            let mut nets = self.nets.clone();
            let mut group = Workgroup {
                nets: Nets::Trained(&mut nets),
                lessons: &mut self.lessons,
                state: self.state,
                ..Workgroup::new(&self.shared, &self.params, forms)
            };
            let found = act(&mut group);
            let state = group.state;
            (found, state, nets)
        });
        assert_eq!(plain.0, tuned.0, "the tuned form finds something else");
        assert!(bytemuck::bytes_of(&plain.1) == bytemuck::bytes_of(&tuned.1), "the tuned form leaves another state");
        let bytes = |nets: &[f32]| bytemuck::cast_slice::<f32, u8>(nets).to_vec();
        assert!(bytes(&plain.2) == bytes(&tuned.2), "the tuned form leaves other nets");
        (self.state, self.nets) = (plain.1, plain.2);
        plain.0
    }

    /// Words of one tensor of a skill's nets.
    pub(crate) fn tensor(&self, skill: usize) -> usize {
        self.shared.skills[skill].rows as usize * LANES
    }

    /// Word of the nets at which a skill's net stands.
    pub(crate) fn net(&self, skill: usize, net: u32) -> usize {
        self.shared.skills[skill].net_offset(net)
    }
}

/// Words of a lesson, as memory and bank hold them: the steps, last the observation that closes the trial.
pub(crate) fn lesson_words(skill: &SkillShape, end: u32, records: &[Step]) -> Vec<u32> {
    let header = LessonHeader { steps: records.len() as u32 - 1, end, reward: 0.0, collisions: 0 };
    let mut words = bytemuck::cast::<_, [u32; LESSON_HEADER_WORDS]>(header).to_vec();
    for record in records {
        words.extend(&bytemuck::cast::<_, [u32; STEP_WORDS]>(*record)[..skill.record_words as usize]);
    }
    words
}

impl Lesson {
    /// The steps, without the closing observation.
    pub(crate) fn steps(&self) -> &[Step] {
        &self.records[..self.header.steps as usize]
    }
}
