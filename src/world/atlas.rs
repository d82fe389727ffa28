//! From a floor plan to the words that the kernels read: the [`WorldPlan`] and the read-only atlas.
