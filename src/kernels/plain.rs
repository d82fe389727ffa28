//! The hot functions in their plain form, as the shaders have them.

use crate::env::workgroup::{HotForms, Workgroup};

/// The twins themselves.
pub const PLAIN: HotForms = HotForms {
    draw_step: |group, stream| group.random.draw_step(stream),
    observe: Workgroup::observe,
    move_body: Workgroup::move_body,
    forward: Workgroup::forward,
    backward: Workgroup::backward,
};
