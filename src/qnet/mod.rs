//! APPROXIMATE: one small net per child, Q(state, child) (paper, section I).
//!
//! Net: inputs, one hidden layer of up to 32 units, one output; tanh on both layers, so Q lies in (-1, 1).
//! A net's memory is three tensors of `rows` x 32 words: weights, first moments, second moments. Row j below
//! `inputs` holds the 32 weights of input j, then come the hidden biases, the output weights, and a row
//! whose first word is the output bias. Lanes are hidden units.
//!
//! Twins: `shaders/qnet/`.

pub mod backward;
pub mod forward;
pub mod gradient;
pub mod init;
pub mod optimiser;
pub mod weights;
