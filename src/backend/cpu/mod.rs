//! The CPU backend: hot functions, most of them in the CPU's way ([`lanes`]), compiled for each instruction set and chosen
//! where the program runs.
//!
//! They are plain arithmetic without fused operations, so the instruction set changes their speed and not their bytes.

pub mod lanes;

use super::BackendError;
use super::host::{HostBackend, HostForms, Vector};
use crate::env::workgroup::{CohortData, HotForms, Workgroup};
use crate::layout::{Boltzmann, Moved, Noise, Robot};
use crate::math::rng::Stream;
use bytemuck::Zeroable;
use multiversion::multiversion;
use multiversion::target::match_target;
use std::hint::black_box;

/// A CPU backend; see [`HostBackend::new`].
///
/// # Errors
/// Where the threads cannot be started.
pub fn cpu_backend(threads: usize, iterations: Option<u32>) -> Result<HostBackend, BackendError> {
    HostBackend::new(&CPU, threads, iterations)
}

/// The tuned forms.
pub const CPU: HostForms = HostForms {
    kind: "cpu",
    instructions,
    hot: HotForms { draw_step, observe, move_body, encode, forward, boltzmann, backward },
    step,
};

/// Compiles a function for each instruction set.
///
/// The vector that nobody reads aligns the function's stack as vectors are. Else what the compiler keeps there lies across
/// two lines of the cache in most processes and not in some: robots step at 3.9 to 6.3 million a second, by chance.
macro_rules! for_each_instruction_set {
    ($($(#[$doc:meta])* fn $name:ident($($argument:ident: $kind:ty),*) $(-> $result:ty)? = $form:expr;)*) => {$(
        $(#[$doc])*
        #[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
        fn $name($($argument: $kind),*) $(-> $result)? {
            black_box(&Vector::zeroed());
            $form($($argument),*)
        }
    )*};
}

for_each_instruction_set! {
    fn draw_step(group: &mut Workgroup<'_>, stream: Stream) = lanes::draws::draw_step;
    fn observe(group: &mut Workgroup<'_>, x: f32, y: f32, heading: f32, bumpers: u32, noise: Noise) =
        lanes::observe::observe;
    fn move_body(group: &Workgroup<'_>, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved =
        lanes::contact::move_body;
    fn encode(group: &mut Workgroup<'_>, skill: u32, mirrored: bool) = Workgroup::encode;
    fn forward(group: &mut Workgroup<'_>, skill: u32) = lanes::forward::forward;
    fn boltzmann(group: &mut Workgroup<'_>, children: u32, allowed: u32, inverse_temperature: f32) -> Boltzmann =
        Workgroup::boltzmann;
    fn backward(group: &mut Workgroup<'_>, skill: u32, child: u32, delta: f32, step_size: f32) =
        lanes::optimiser::backward;
    fn step_once(robots: &mut [Robot], shared: &CohortData) = lanes::step::step;
}

fn step(robots: &mut [Robot], shared: &CohortData, iterations: u32) {
    for _iteration in 0..iterations {
        step_once(robots, shared);
    }
}

/// The instruction set chosen, in words.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn instructions() -> &'static str {
    match_target! {
        "x86_64+avx512f+avx512vl+avx512dq+avx512bw" => "AVX-512",
        "x86_64+avx2" => "AVX2",
        _ => "baseline",
    }
}
