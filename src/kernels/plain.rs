//! The hot functions in their plain form, as the shaders have them.

use crate::env::workgroup::HotForms;

/// The twins themselves.
pub const PLAIN: HotForms = HotForms {
    draw_step: |group, stream| group.random.draw_step(stream),
    observe: |group, x, y, heading, bumpers, noise| group.observe(x, y, heading, bumpers, noise),
    move_body: |group, x, y, heading, action, slip| group.move_body(x, y, heading, action, slip),
    forward: |group, skill| group.forward(skill),
    backward: |group, skill, child, delta, step_size| group.backward(skill, child, delta, step_size),
};
