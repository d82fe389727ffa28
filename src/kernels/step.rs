//! Kernel `step`: one robot carries out one given action and senses.
//!
//! For `probe`, benchmarks and callers that decide for themselves.

use crate::env::motion::NO_ACTION;
use crate::env::observe::DRAW_ACTUATOR;
use crate::env::workgroup::Workgroup;
use crate::layout::Robot;
use crate::math::rng::{Purpose, Stream, noise};

impl Workgroup<'_> {
    /// A robot carries out its action `dispatch.iterations` times.
    pub fn step(&mut self, robots: &mut Robot) {
        let mut robot = *robots;
        for _iteration in 0..self.dispatch.iterations {
            let key = [robot.run_seed, robot.robot_seed];
            let stream = Stream { key, skill: 0, trial: 0, step: robot.step, purpose: Purpose::Given as u32 };
            (self.forms.draw_step)(self, stream);
            if robot.action != NO_ACTION {
                let slip = robot.noise.actuator
                    * noise(robot.noise.kind, self.random.x[DRAW_ACTUATOR], self.random.y[DRAW_ACTUATOR])
                    + 1.0;
                let moved = (self.forms.move_body)(self, robot.x, robot.y, robot.heading, robot.action, slip);
                robot.x = moved.x;
                robot.y = moved.y;
                robot.heading = moved.heading;
                robot.bumpers = moved.bumpers;
                robot.events = moved.events;
            }
            (self.forms.observe)(self, robot.x, robot.y, robot.heading, robot.bumpers, robot.noise);
            robot.step += 1;
        }
        robot.sensed = self.record.observation;
        *robots = robot;
    }
}
