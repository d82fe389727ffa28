//! Whether a drawing can be seen: well-formed, numbers everywhere, shapes within the page, enough of them.

use std::path::Path;

/// Values of an attribute in tags of a name.
fn attributes<'a>(svg: &'a str, tag: &str, name: &str) -> Vec<&'a str> {
    let tags = svg.split('<').filter(move |part| part.strip_prefix(tag).is_some_and(|rest| rest.starts_with(' ')));
    let start = format!(" {name}=\"");
    tags.filter_map(|part| part.split_once(&start)?.1.split('"').next()).collect()
}

/// Every tag is closed in turn.
fn well_formed(svg: &str) -> bool {
    let mut open: Vec<&str> = Vec::new();
    for part in svg.split('<').skip(1) {
        let Some((tag, text)) = part.split_once('>') else { return false };
        if text.contains('>') || text.split('&').skip(1).any(|entity| !entity.contains(';')) {
            return false;
        }
        match tag.strip_prefix('/') {
            Some(closing) if open.pop() != Some(closing) => return false,
            None if !tag.ends_with('/') => open.push(tag.split(' ').next().unwrap_or_default()),
            _ => {}
        }
    }
    open.is_empty()
}

pub(crate) fn check(svg: &str, path: &Path) {
    let path = path.display();
    assert!(well_formed(svg), "{path}");
    assert!(!svg.contains("NaN") && !svg.contains("inf\"") && !svg.contains("inf,"), "{path}");
    let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{path}: `{text}`"));
    let size = ["width", "height"].map(|side| number(attributes(svg, "svg", side)[0]));
    assert!(size.iter().all(|side| (200.0..1_000.0).contains(side)), "{path}: {size:?}");
    let lists = ["polyline", "polygon"].map(|tag| attributes(svg, tag, "points")).concat();
    let mut places: Vec<[f64; 2]> = Vec::new();
    for pair in lists.iter().flat_map(|list| list.split(' ')) {
        let (x, y) = pair.split_once(',').unwrap_or_else(|| panic!("{path}: `{pair}`"));
        places.push([number(x), number(y)]);
    }
    for (tag, x, y) in [("circle", "cx", "cy"), ("text", "x", "y")] {
        places
            .extend(attributes(svg, tag, x).into_iter().zip(attributes(svg, tag, y)).map(|(x, y)| [x, y].map(number)));
    }
    let outside = places.iter().filter(|place| (0..2).any(|i| !(-0.01..=size[i] + 0.01).contains(&place[i])));
    assert_eq!(outside.collect::<Vec<_>>(), Vec::<&[f64; 2]>::new(), "{path}");
    assert!(places.len() > 40, "{path}: {} places", places.len());
    let mut sizes = attributes(svg, "text", "font-size").into_iter().map(number);
    assert!(sizes.all(|size| (9.0..=60.0).contains(&size)), "{path}");
}

#[test]
fn drawings_that_nobody_can_see_are_found() {
    let within = (0..50).map(|i| format!("{i},9")).collect::<Vec<_>>().join(" ");
    let svg = |points: &str, tail: &str| {
        format!(
            "<svg width=\"300\" height=\"300\"><polyline points=\"{points}\"/><text x=\"1\" y=\"2\" font-size=\"12\">a&amp;b</text>{tail}"
        )
    };
    let seen = |svg: String| std::panic::catch_unwind(|| check(&svg, Path::new("a drawing"))).is_ok();
    assert!(seen(svg(&within, "</svg>")));
    assert!(!seen(svg(&within, "")) && !seen(svg(&within, "<g></svg></g>")) && !seen(svg(&within, "a & b</svg>")));
    assert!(!seen(svg(&format!("{within} 301,9"), "</svg>")) && !seen(svg(&format!("{within} NaN,9"), "</svg>")));
    assert!(!seen(svg("1,1 2,2", "</svg>")));
}
