//! Dispatches in flight: the next one is submitted before the oldest is waited for, so that the device does not idle
//! while the host hears of an end and encodes what follows.

use super::device::Device;
use super::dispatch_size::{Governor, Share};
use super::pipeline::Pipeline;
use crate::backend::BackendError;
use crate::layout::Dispatch;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Dispatches that the host keeps submitted: one runs, and the next is there when it ends.
pub const IN_FLIGHT: usize = 2;

/// A dispatch that was submitted and not yet waited for.
#[derive(Debug)]
struct Sent {
    share: Share,
    submission: wgpu::SubmissionIndex,
    at: Instant,
}

/// Dispatches of one kernel, one after another.
#[derive(Debug)]
pub struct Flight<'a> {
    device: &'a Device,
    pipeline: &'a Pipeline,
    uniform: &'a wgpu::Buffer,
    governor: &'a mut Governor,
    traffic: &'a mut Traffic,
    sent: VecDeque<Sent>,
    clock: Clock,
    fullest: Option<(Share, Duration)>,
}

impl<'a> Flight<'a> {
    /// Nothing in flight yet.
    pub fn new(
        device: &'a Device,
        (pipeline, governor): (&'a Pipeline, &'a mut Governor),
        uniform: &'a wgpu::Buffer,
        traffic: &'a mut Traffic,
    ) -> Self {
        let (sent, clock) = (VecDeque::new(), Clock::default());
        Self { device, pipeline, uniform, governor, traffic, sent, clock, fullest: None }
    }

    /// Size of the next dispatch over `waiting` workgroups.
    pub fn share(&self, waiting: u32) -> Share {
        self.governor.share(waiting)
    }

    /// Submits a dispatch of `size` workgroups along both axes. Then waits for the oldest if as many are in flight as
    /// may be: the uniform is written in the queue, so that those on their way keep theirs.
    pub fn send(
        &mut self,
        group: &wgpu::BindGroup,
        dispatch: &Dispatch,
        share: Share,
        size: (u32, u32),
    ) -> Result<(), BackendError> {
        self.device.queue.write_buffer(self.uniform, 0, bytemuck::bytes_of(dispatch));
        let at = Instant::now();
        let submission = self.pipeline.submit(self.device, group, size);
        self.sent.push_back(Sent { share, submission, at });
        self.traffic.most = self.traffic.most.max(self.sent.len());
        while self.sent.len() >= self.traffic.limit {
            self.wait()?;
        }
        Ok(())
    }

    /// Waits until nothing is in flight.
    pub fn land(&mut self) -> Result<(), BackendError> {
        while !self.sent.is_empty() {
            self.wait()?;
        }
        Ok(())
    }

    /// Tells the governor whether most workgroups of what has landed since it was told last had work to the end. True
    /// where dispatches are far from their size.
    pub fn learn(&mut self, busy: bool) -> bool {
        self.fullest.take().is_some_and(|(share, elapsed)| self.governor.took(share, elapsed, busy))
    }

    /// Waits for the oldest. What fails stays the device's fault, so that whatever follows tells of it, and of nothing
    /// that is still in flight a result is read.
    fn wait(&mut self) -> Result<(), BackendError> {
        let Some(Sent { share, submission, at }) = self.sent.pop_front() else { return Ok(()) };
        self.device.wait(self.pipeline.name(), Some(submission))?;
        let elapsed = self.clock.ended(at, Instant::now());
        self.traffic.spent += elapsed;
        self.governor.took(share, elapsed, false);
        if self.fullest.is_none_or(|(fullest, _)| share.work() >= fullest.work()) {
            self.fullest = Some((share, elapsed));
        }
        Ok(())
    }
}

/// How many dispatches over all workgroups follow one another before the host looks at what they left. Twice as many
/// each time that most had work to the end, so that no more of them can be idle than had work before. One as long as
/// dispatches grow, which takes a look.
#[derive(Debug, Clone, Copy)]
pub struct Rounds(u32);

/// Most rounds between two looks.
const ROUNDS: u32 = 8;

impl Default for Rounds {
    fn default() -> Self {
        Self(1)
    }
}

impl Rounds {
    /// Rounds until the next look.
    pub fn count(self) -> u32 {
        self.0
    }

    /// Learns whether most workgroups had work to the end, and whether dispatches grow.
    pub fn looked(&mut self, busy: bool, grows: bool) {
        self.0 = if busy && !grows { (2 * self.0).min(ROUNDS) } else { 1 };
    }
}

/// Tells how long each dispatch took on a device that carries them out one after another.
#[derive(Debug, Default)]
struct Clock {
    last: Option<Instant>,
}

impl Clock {
    /// Time of a dispatch submitted at `sent` that ended `now`: where it had to queue, since the one before it ended.
    fn ended(&mut self, sent: Instant, now: Instant) -> Duration {
        let begun = self.last.map_or(sent, |last| last.max(sent));
        self.last = Some(now);
        now.duration_since(begun)
    }
}

/// How many dispatches may be in flight, how many were, and how long all took.
#[derive(Debug)]
pub struct Traffic {
    limit: usize,
    /// Most dispatches that were submitted and not yet waited for. Whether the device had ended one of them by then, no
    /// driver tells without being waited for.
    pub most: usize,
    /// Time that the governor was told, in all.
    pub spent: Duration,
}

impl Traffic {
    /// At most `limit` in flight.
    pub fn new(limit: usize) -> Self {
        Self { limit: limit.max(1), most: 0, spent: Duration::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_looks_seldom_while_all_have_work_and_soon_when_they_have_not() {
        let mut rounds = Rounds::default();
        let mut seen = Vec::new();
        for (busy, grows) in [(true, true), (true, false), (true, false), (true, false), (true, false), (false, false)]
        {
            seen.push(rounds.count());
            rounds.looked(busy, grows);
        }
        assert_eq!((seen, rounds.count()), (vec![1, 1, 2, 4, 8, 8], 1));
    }

    #[test]
    fn a_dispatch_that_queued_took_the_time_since_the_one_before_it() {
        let begun = Instant::now();
        let at = |milliseconds: u64| begun + Duration::from_millis(milliseconds);
        let mut clock = Clock::default();
        let took = |clock: &mut Clock, sent: u64, ended: u64| clock.ended(at(sent), at(ended)).as_millis();
        assert_eq!(took(&mut clock, 0, 50), 50);
        // Submitted at 1, begun at 50; submitted at 51, begun at 110.
        assert_eq!(took(&mut clock, 1, 110), 60);
        assert_eq!(took(&mut clock, 51, 130), 20);
        // The device was idle until 200.
        assert_eq!(took(&mut clock, 200, 230), 30);
    }
}
