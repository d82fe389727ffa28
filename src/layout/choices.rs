//! Words of a config that are codes in a learner's memory: a row each.

macro_rules! choices {
    ($($(#[$doc:meta])+ $words:ident { $($(#[$word_doc:meta])+ $code:ident = $number:literal, $text:literal;)+ })*) => {
        $(
            $($(#[$word_doc])+ pub const $code: u32 = $number;)+
            $(#[$doc])+
            pub const $words: &[&str] = {
                let (words, codes) = (&[$($text),+], [$($number),+]);
                let mut place = 0;
                while place < codes.len() {
                    assert!(codes[place] == place, "a code is its word's place");
                    place += 1;
                }
                words
            };
        )*
        /// Name in shaders and value of every code.
        pub(super) const CODES: &[(&str, u32)] = &[$($((stringify!($code), $code)),+),*];
    };
}

choices! {
    /// Weight update rules.
    OPTIMISERS {
        /// Gradient descent with momentum.
        OPTIMISER_SGD = 0, "sgd";
        /// Adam with bias correction.
        OPTIMISER_ADAM = 1, "adam";
        /// Adam with one second moment for each row of weights (after Adam-mini).
        OPTIMISER_ADAM_ROWS = 2, "adam-rows";
    }

    /// Distributions of a noise term.
    NOISE_KINDS {
        /// The amount is a standard deviation (four 16-bit uniforms summed; nothing beyond 3.46 deviations).
        NOISE_GAUSSIAN = 0, "gaussian";
        /// The amount is the half-width.
        NOISE_UNIFORM = 1, "uniform";
    }

    /// How a child is chosen.
    POLICIES {
        /// By the learned Q-values.
        POLICY_LEARNED = 0, "learned";
        /// Uniformly at random among those allowed. A baseline.
        POLICY_RANDOM = 1, "random";
        /// The first allowed one, in the order of `children`. A baseline.
        POLICY_FIXED_PRIORITY = 2, "fixed-priority";
    }

    /// How a skill over skills is learned from a recorded trial.
    BACKUPS {
        /// From every step, the best next value over all applicable children: the paper read literally.
        BACKUP_STEPS = 0, "steps";
        /// From every step, the best next value over the children that persistence would allow.
        BACKUP_PERSISTENT = 1, "persistent";
        /// At decisions only, semi-Markov; lambda mixes there.
        BACKUP_DECISIONS = 2, "decisions";
    }
}
