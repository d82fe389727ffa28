//! Which lessons are replayed.

use super::docking;

#[test]
fn replayed_lessons_have_exponential_ages_cut_at_the_oldest() {
    for (memory, mean, remembered) in
        [(300, 100.0, 1), (300, 100.0, 2), (300, 100.0, 150), (50, 10.0, 50), (50, 10.0, 173), (40, 500.0, 99)]
    {
        let set = [format!("learning.replay_capacity={memory}"), format!("learning.replay_mean_age={mean:?}")];
        let mut learner = docking(&[&set[0], &set[1]]);
        learner.state.remembered = remembered;
        let stride = learner.shared.skills[0].lesson_stride;
        let kept = remembered.min(memory);
        // Every random word of an even grid: the shares are exact to one part in the grid.
        let grid = 1_u32 << 18;
        let mut counts = vec![0_u32; kept as usize];
        let drawn = learner.seen(|group| (0..grid).map(|i| group.recent_lesson(i << 14 | 1 << 13)).collect::<Vec<_>>());
        for lesson in drawn {
            let slot = lesson / stride;
            let age = (0..kept).find(|age| (remembered - 1 - age) % memory == slot).expect("a lesson that is kept");
            counts[age as usize] += 1;
        }
        let weight = |age: u32| (-f64::from(age) / mean).exp() - (-f64::from(age + 1) / mean).exp();
        let total = 1.0 - (-f64::from(kept) / mean).exp();
        for (age, count) in counts.iter().enumerate() {
            let share = f64::from(*count) / f64::from(grid);
            let expected = weight(age as u32) / total;
            // ln and exponential err by 1e-6 at most, which shifts the borders of an age by 1e-6 of the mean.
            assert!((share - expected).abs() < 2.0e-5, "{memory} {mean} {remembered}: age {age}: {share} {expected}");
        }
    }
}

#[test]
fn taught_lessons_are_distinct_one_from_each_stratum() {
    let mut learner = docking(&["skill.dock.lessons=10"]);
    learner.shared.skills[0].bank_offset = 77;
    learner.shared.skills[0].bank_lessons = 256;
    let stride = learner.shared.skills[0].lesson_stride;
    let mut counts = [0_u32; 25];
    for seed in 0..2000 {
        learner.params[0].learner_seed = seed;
        let drawn = learner.seen(|group| [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|number| group.taught_lesson(number)));
        for (number, word) in (0..).zip(drawn.map(|word| word - 77)) {
            assert_eq!(word % stride, 0);
            let index = word / stride;
            assert!((number * 25..number * 25 + 25).contains(&index), "lesson {number}: {index}");
            counts[(index - number * 25) as usize] += 1;
        }
    }
    // Chi-square with 24 degrees of freedom: 60 is exceeded once in 15,000 times.
    let chi: f64 = counts.iter().map(|count| (f64::from(*count) - 800.0).powi(2) / 800.0).sum();
    assert!(chi < 60.0, "{chi}: {counts:?}");
}
