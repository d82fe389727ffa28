//! Test trials on the device: dispatched until all have ended.

use super::device::Device;
use super::dispatch_size::Share;
use super::in_flight::{Flight, Rounds};
use super::source::EVALUATE;
use crate::backend::BackendError;
use crate::layout::EPISODE_TERMINATED;
use crate::layout::{Dispatch, Episode};

/// No trial is longer than this: step limits are at most 255.
const LONGEST: u32 = 1 << 16;

/// Runs the trials that one dispatch is over, and reads them back.
///
/// # Errors
/// Where the device fails, or a trial does not end.
pub(super) fn finish(
    device: &Device,
    mut flight: Flight<'_>,
    (binding, results): (&wgpu::BindGroup, &wgpu::Buffer),
    mut dispatch: Dispatch,
    episodes: &mut [Episode],
) -> Result<(), BackendError> {
    device.upload(EVALUATE.name, results, bytemuck::cast_slice(episodes))?;
    let groups = episodes.len() as u32;
    let size = (groups / dispatch.episodes, dispatch.episodes);
    let mut iterations = 0;
    let mut rounds = Rounds::default();
    while iterations < LONGEST {
        for _round in 0..rounds.count() {
            let share = Share { groups, iterations: flight.share(groups).iterations };
            dispatch.iterations = share.iterations;
            flight.send(binding, &dispatch, share, size)?;
            iterations += share.iterations;
        }
        flight.land()?;
        device.download(EVALUATE.name, results, bytemuck::cast_slice_mut(episodes))?;
        let running = episodes.iter().filter(|episode| episode.state < EPISODE_TERMINATED).count();
        let busy = 2 * running >= episodes.len();
        rounds.looked(busy, flight.learn(busy));
        if running == 0 {
            return Ok(());
        }
    }
    Err(BackendError::Device { kernel: EVALUATE.name, message: "a test trial does not end".to_owned() })
}
