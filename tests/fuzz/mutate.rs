//! Inputs made from good ones: bytes, numbers and words are altered, lost, doubled and mixed.

/// Random numbers (splitmix64): the same inputs in every run.
pub(crate) struct StepRandom(u64);

impl StepRandom {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    pub(crate) fn draw_step(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`, and 0 if that is 0.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.draw_step() % end.max(1) as u64) as usize
    }

    pub(crate) fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// A stretch of something that is `length` long; most are short.
    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let most = if self.below(4) == 0 { length } else { 16 };
        start..(start + self.below(most + 1)).min(length)
    }
}

/// Words whose bits are the edges of what numbers can be.
pub(crate) const EDGES: [u32; 14] = [
    0,
    1,
    2,
    0x7f,
    0x80,
    0xffff,
    0x1_0000,
    0x00ff_ffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x7f80_0000, // infinity
    0x7fc0_0000, // not a number
    0x0000_0001, // the least f32
];

const NUMBERS: [&str; 22] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "0.0",
    "-0.0",
    "1e-320",
    "1e-30",
    "1e30",
    "1e308",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "9223372036854775808",
    "0.1",
    "65536",
];

/// One to four alterations of one of the seeds, byte by byte.
pub(crate) fn bytes(random: &mut StepRandom, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut input = random.pick(seeds).clone();
    for _ in 0..=random.below(4) {
        let at = random.below(input.len());
        let range = random.range(input.len());
        match random.below(9) {
            0 if !input.is_empty() => input[at] ^= 1 << random.below(8),
            1 if !input.is_empty() => input[at] = *random.pick(&[0, 1, 0x7f, 0x80, 0xff]),
            2 => input.truncate(at),
            3 => drop(input.drain(range)),
            4 => {
                let copy = input[range].to_vec();
                input.splice(at..at, copy);
            }
            5 => {
                let other = random.pick(seeds);
                let from = random.range(other.len());
                input.splice(range, other[from].iter().copied());
            }
            6 => {
                let word = random.pick(&EDGES).to_le_bytes();
                let at = if random.below(2) == 0 { at / 4 * 4 } else { at };
                input.iter_mut().skip(at).zip(word).for_each(|(byte, new)| *byte = new);
            }
            7 => input.iter_mut().skip(at).take(8).for_each(|byte| *byte = byte.wrapping_add(1)),
            _ => {
                let noise: Vec<u8> = (0..random.below(9)).map(|_| random.draw_step() as u8).collect();
                input.splice(at..at, noise);
            }
        }
    }
    input
}

/// A text cut into words, numbers, signs and white space.
fn tokens(text: &str) -> Vec<String> {
    let class = |c: char| match c {
        c if c.is_alphanumeric() || "_-+.".contains(c) => 0,
        '\n' => 1,
        c if c.is_whitespace() => 2,
        _ => 3,
    };
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        match tokens.last_mut().filter(|last| class(c) != 3 && last.chars().last().map(class) == Some(class(c))) {
            Some(last) => last.push(c),
            None => tokens.push(c.to_string()),
        }
    }
    tokens
}

/// One to four alterations of one of the texts, word by word or line by line; now and then byte by byte.
pub(crate) fn text(random: &mut StepRandom, seeds: &[Vec<u8>]) -> Vec<u8> {
    if random.below(8) == 0 {
        return bytes(random, seeds);
    }
    let read = |seed: &Vec<u8>| String::from_utf8_lossy(seed).into_owned();
    let mut words = tokens(&read(random.pick(seeds)));
    for _ in 0..=random.below(4) {
        let at = random.below(words.len());
        let range = random.range(words.len());
        match random.below(9) {
            0 => drop(words.drain(range)),
            1 => {
                let copy = words[range].to_vec();
                words.splice(at..at, copy);
            }
            2 => {
                let other = random.below(words.len());
                if !words.is_empty() {
                    words.swap(at, other);
                }
            }
            3 | 4 => {
                let is_number = |word: &String| word.chars().any(|c| c.is_ascii_digit()) && word.parse::<f64>().is_ok();
                let numbers: Vec<usize> = (0..words.len()).filter(|&i| is_number(&words[i])).collect();
                if !numbers.is_empty() {
                    words[*random.pick(&numbers)] = (*random.pick(&NUMBERS)).to_owned();
                }
            }
            5 => {
                let other = tokens(&read(random.pick(seeds)));
                let from = random.range(other.len());
                words.splice(range, other[from].iter().cloned());
            }
            6 if !words.is_empty() => {
                words[at] = read(random.pick(seeds)).lines().nth(at % 50).unwrap_or("").to_owned()
            }
            7 => {
                let nested = (*random.pick(&["[", "{ a = ", "[[", "(", "\"", "{\"a\":", "a.", "é"]))
                    .repeat(1 + random.below(300));
                words.insert(at, nested);
            }
            _ => {
                let seed = read(random.pick(seeds));
                let lines: Vec<&str> = seed.lines().collect();
                let line = if lines.is_empty() { "" } else { *random.pick(&lines) };
                let breaks: Vec<usize> = (0..words.len()).filter(|&i| words[i].starts_with('\n')).collect();
                let at = if breaks.is_empty() { 0 } else { *random.pick(&breaks) };
                words.insert(at, format!("\n{line}"));
            }
        }
    }
    words.concat().into_bytes()
}
