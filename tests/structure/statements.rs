//! Statements of WGSL and Rust in one form, so that twins can be compared.
//!
//! What the two languages must write differently is taken out or written the same way: types and casts, references,
//! `self`, brackets, `select` against `if`, loops, atomics, barriers, and the loops over lanes that a workgroup does not
//! need. What remains are the names, the operators and the numbers, in their order.

use similar::{Algorithm, capture_diff_slices, diff_ratio};

/// How alike the statements of two texts are, 0 to 1: twice the tokens in common over the tokens in all.
pub(crate) fn likeness(wgsl: &str, rust: &str) -> f32 {
    let (left, right) = (normalised(wgsl), normalised(rust));
    diff_ratio(&capture_diff_slices(Algorithm::Lcs, &left, &right), left.len(), right.len())
}

/// What is written the same way in one step.
type Step = fn(&[String]) -> Vec<String>;

/// The tokens of all functions of a text, in one form for both languages.
pub(crate) fn normalised(text: &str) -> Vec<String> {
    let tokens = tokens(text);
    let bodies: Vec<String> = functions(&tokens).into_iter().flat_map(|(name, body)| named(name, body)).collect();
    let steps: [Step; 7] = [without_types, words_of_records, loops, atomics, selections, without_lanes, without_marks];
    steps.iter().fold(bodies, |tokens, step| step(&tokens))
}

fn named(name: &str, body: &[String]) -> Vec<String> {
    [["fn".to_owned(), name.to_owned()].as_slice(), body].concat()
}

/// Splits a text into words, numbers and operators; comments and attributes are left out.
fn tokens(text: &str) -> Vec<String> {
    const LONG: [&str; 16] =
        ["..=", "<<=", ">>=", "::", "->", "=>", "..", "<=", ">=", "==", "!=", "&&", "||", "+=", "-=", "|="];
    let mut found = Vec::new();
    for line in text.lines().map(|line| line.split("//").next().unwrap_or("")) {
        if line.trim_start().starts_with(['#', '@']) {
            continue;
        }
        let mut rest = line.trim_start();
        while let Some(first) = rest.chars().next() {
            let length = if first.is_ascii_digit() {
                let number = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let mut end = rest.find(|c| !number(c)).unwrap_or(rest.len());
                if rest[end..].starts_with('.') && rest[end + 1..].starts_with(|c: char| c.is_ascii_digit()) {
                    end += 1 + rest[end + 1..].find(|c| !number(c)).unwrap_or(rest.len() - end - 1);
                }
                if rest[..end].ends_with('e') && rest[end..].starts_with(['-', '+']) {
                    end += 1 + rest[end + 1..].find(|c| !number(c)).unwrap_or(rest.len() - end - 1);
                }
                end
            } else if first.is_alphabetic() || first == '_' {
                rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
            } else {
                LONG.iter().find(|long| rest.starts_with(**long)).map_or(first.len_utf8(), |long| long.len())
            };
            let token = &rest[..length];
            found.push(if first.is_ascii_digit() { number(token) } else { token.to_owned() });
            rest = rest[length..].trim_start();
        }
    }
    found
}

/// A number without its suffix and separators.
fn number(token: &str) -> String {
    let plain = token.replace('_', "");
    if let Some(hex) = plain.strip_prefix("0x") {
        let digits = hex.trim_end_matches("u32").trim_end_matches('u');
        return u64::from_str_radix(digits, 16).map_or(plain.clone(), |value| value.to_string());
    }
    let digits = plain.trim_end_matches("u32").trim_end_matches("f32").trim_end_matches(['u', 'f', 'i']);
    digits.parse::<f32>().map_or(plain.clone(), |value| value.to_string())
}

/// Name and body of each function.
fn functions(tokens: &[String]) -> Vec<(&str, &[String])> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = tokens[at..].iter().position(|token| token == "fn").map(|start| at + start) {
        let open = start + tokens[start..].iter().position(|token| token == "{").expect("a body");
        let close = matching(tokens, open);
        found.push((tokens[start + 1].as_str(), &tokens[open + 1..close]));
        at = close;
    }
    found
}

/// Where the bracket at `open` is closed.
fn matching(tokens: &[String], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    panic!("`{}` is not closed", tokens[open..].join(" "));
}

/// Arguments of the call whose bracket is at `open`.
fn arguments(tokens: &[String], open: usize) -> Vec<&[String]> {
    let close = matching(tokens, open);
    let (mut found, mut from, mut at) = (Vec::new(), open + 1, open + 1);
    while at < close {
        match tokens[at].as_str() {
            "(" | "[" | "{" => at = matching(tokens, at),
            "," => {
                found.push(&tokens[from..at]);
                from = at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    if from < close {
        found.push(&tokens[from..close]);
    }
    found
}

fn is(tokens: &[String], at: usize, word: &str) -> bool {
    tokens.get(at).is_some_and(|token| token == word)
}

/// Takes out types, casts, references and what only Rust names.
fn without_types(tokens: &[String]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let token = tokens[at].as_str();
        let called = is(tokens, at + 1, "(");
        match token {
            "as" => at += 1,
            "mut" | "pub" | "return" => {}
            "var" | "let" => {
                out.push("let".to_owned());
                // A type stands between the name and the value.
                let name = if is(tokens, at + 1, "mut") { at + 2 } else { at + 1 };
                if is(tokens, name + 1, ":") {
                    out.push(tokens[name].clone());
                    at = name + tokens[name..].iter().position(|token| token == "=").expect("a value") - 1;
                }
            }
            "bitcast" | "array" | "vec2" | "vec3" | "vec4" if is(tokens, at + 1, "<") => {
                at += tokens[at..].iter().position(|token| token == ">").expect("a type");
            }
            "u32" | "f32" | "i32" if called => {}
            "Purpose" => {
                at += 2;
                let shouted: String = tokens[at]
                    .chars()
                    .flat_map(|c| if c.is_uppercase() { vec!['_', c] } else { vec![c.to_ascii_uppercase()] })
                    .collect();
                out.push(format!("PURPOSE{shouted}"));
            }
            "Self" | "f32" | "u32" if is(tokens, at + 1, "::") => at += 1,
            "from" | "from_bits" | "to_bits" | "self" | "forms" | "draws" => {}
            "&" if !out.last().is_some_and(|last| {
                last.ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ')' || c == ']')
            }) => {}
            _ if is(tokens, at + 1, "::") => at += 1,
            // A field of a struct that is written down.
            _ if is(tokens, at + 1, ":") => at += 1,
            _ => out.push(token.to_owned()),
        }
        at += 1;
    }
    out
}

/// `record[STEP_CHOICE]` and `record.choice` are the same.
fn words_of_records(tokens: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let token = tokens[at].as_str();
        if let Some(field) = token.strip_prefix("STEP_").or_else(|| token.strip_prefix("OBSERVATION_"))
            && is(tokens, at.wrapping_sub(1), "[")
        {
            out.push(field.to_lowercase());
        } else if token == "observation" || (token == "record" && is(tokens, at + 2, "observation")) {
            // Rust has the observation as a part of the record, and its methods there.
            let method = tokens[at..].iter().take(6).any(|token| token == "(");
            if token == "record" && !method {
                out.push(token.to_owned());
            }
            at += 1;
        } else if token == "world" && is(tokens, at + 1, ".") && is(tokens, at + 3, "(") {
            at += 1;
        } else {
            out.push(token.to_owned());
        }
        at += 1;
    }
    out
}

/// `for (var i = 0; i < n; i++)` becomes `for i in 0 .. n`.
fn loops(tokens: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at] == "for" && is(tokens, at + 1, "(") && is(tokens, at + 2, "let") {
            let close = matching(tokens, at + 1);
            let parts: Vec<&[String]> = tokens[at + 2..close].split(|token| token == ";").collect();
            let (name, first) = (&parts[0][1], &parts[0][3..]);
            let range = match parts[1][1].as_str() {
                "<" => "..",
                "<=" => "..=",
                _ => "while",
            };
            out.extend(["for".to_owned(), name.clone(), "in".to_owned()]);
            out.extend_from_slice(first);
            out.push(range.to_owned());
            out.extend_from_slice(&parts[1][2..]);
            if parts[2][1] == "+=" {
                out.push("step_by".to_owned());
                out.extend_from_slice(&parts[2][2..]);
            }
            at = close;
        } else {
            out.push(tokens[at].clone());
        }
        at += 1;
    }
    out
}

/// Atomic operations become plain ones.
fn atomics(tokens: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let between: Option<&[&str]> = match tokens[at].as_str() {
            "atomicStore" => Some(&["="]),
            "atomicMin" => Some(&["=", "", "min"]),
            "atomicOr" => Some(&["|="]),
            "atomicLoad" => Some(&[]),
            _ => None,
        };
        match between {
            Some(between) => {
                let parts = arguments(tokens, at + 1);
                out.extend_from_slice(parts[0]);
                for word in between {
                    out.extend_from_slice(&if word.is_empty() { parts[0].to_vec() } else { vec![(*word).to_owned()] });
                }
                out.extend(parts.iter().skip(1).flat_map(|part| part.iter().cloned()));
                at = matching(tokens, at + 1);
            }
            None => out.push(tokens[at].clone()),
        }
        at += 1;
    }
    out
}

/// `select(f, t, c)` becomes `if c t else f`.
fn selections(tokens: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at] == "select" {
            let parts: Vec<Vec<String>> = arguments(tokens, at + 1).into_iter().map(selections).collect();
            out.push("if".to_owned());
            out.extend_from_slice(&parts[2]);
            out.extend_from_slice(&parts[1]);
            out.push("else".to_owned());
            out.extend_from_slice(&parts[0]);
            at = matching(tokens, at + 1);
        } else {
            out.push(tokens[at].clone());
        }
        at += 1;
    }
    out
}

/// A loop over all lanes is no statement of a workgroup, and a lane's condition is a loop over some.
fn without_lanes(tokens: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let rest: Vec<&str> = tokens[at..].iter().take(6).map(String::as_str).collect();
        match rest.as_slice() {
            ["workgroupBarrier" | "storageBarrier", ..] => at += 1,
            ["for", "lane", "in", "0", "..", "LANES" | "units"] => at += 5,
            ["if", "lane", "==", ..] => at += 3,
            ["if", "lane", "<", "units", ..] => at += 3,
            ["if", "lane", "<", ..] => {
                out.extend(["for", "in", "0", ".."].map(str::to_owned));
                at += 2;
            }
            ["params_base" | "nets_base" | "lessons_base" | "rows_base" | "answer_base", "+", ..] => at += 1,
            [";", "LANES", ..] => at += 1,
            ["lane", ..] => {}
            _ => out.push(tokens[at].clone()),
        }
        at += 1;
    }
    out
}

/// Marks of grouping say nothing that the order does not; coordinates of a vector are its numbers.
fn without_marks(tokens: &[String]) -> Vec<String> {
    let kept = tokens.iter().filter(|token| !"(){}[],;.".contains(token.as_str()));
    let coordinate = |token: &String| match token.as_str() {
        "x" => "0".to_owned(),
        "y" => "1".to_owned(),
        "z" => "2".to_owned(),
        "w" => "3".to_owned(),
        _ => token.clone(),
    };
    kept.map(coordinate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_languages_write_differently_is_alike() {
        let wgsl = "fn clip(lane: u32, at: f32) -> f32 {\n    // A bound.\n    let low = select(0.0f, at, at > 0.0f);\n    \
                    for (var i = 0u; i < LANES; i += 2u) {\n        sums[i] = f32(i) * low;\n    }\n    return low;\n}";
        let rust = "impl Workgroup<'_> {\n    pub fn clip(&mut self, at: f32) -> f32 {\n        \
                    let low = if at > 0.0 { at } else { 0.0 };\n        for i in (0..LANES).step_by(2) {\n            \
                    self.sums[i] = i as f32 * low;\n        }\n        low\n    }\n}";
        assert_eq!(normalised(wgsl), normalised(rust));
        assert_eq!(likeness(wgsl, rust), 1.0);
        assert!(likeness(wgsl, &rust.replace("at > 0.0 { at }", "at < 1.0 { low + at }")) < 0.95);
    }
}
