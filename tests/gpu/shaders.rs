//! Every shipped kernel, checked without a graphics card: it parses, keeps to the numerical contract, and
//! lays its memory out as Rust does.
#![cfg(feature = "gpu")]

use naga::{
    AddressSpace, BinaryOperator, Expression, Function, GatherMode, Handle, MathFunction, ScalarKind, Statement,
    TypeInner,
};
use skilltree::backend::gpu::source::{KERNELS, Kernel};
use skilltree::backend::gpu::spirv::{Checked, check};
use skilltree::layout::{LANES, LAYOUTS, Layout};
use std::collections::BTreeSet;
use std::path::Path;

fn checked(name: &str, wgsl: &str) -> Checked {
    check(wgsl).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_kernel_is_valid_and_its_entry_point_bears_its_name() {
    for kernel in KERNELS {
        let module = checked(kernel.name, &kernel.wgsl()).module;
        let entries: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(entries, [kernel.name]);
        assert_eq!(module.entry_points[0].workgroup_size, [LANES as u32, 1, 1]);
    }
}

/// The table of kernels is the truth: a file that no kernel uses is dead.
#[test]
fn every_shader_file_belongs_to_a_kernel() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut files = BTreeSet::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.insert(path.strip_prefix(&root).expect("below").to_string_lossy().into_owned());
            }
        }
    }
    let used: BTreeSet<String> = KERNELS.iter().flat_map(Kernel::files).map(|part| part.path.to_owned()).collect();
    assert_eq!(files, used);
}

/// Default limits of WebGPU: any adapter can run every kernel.
#[test]
fn kernels_keep_to_the_limits_of_every_adapter() {
    for kernel in KERNELS {
        let checked = checked(kernel.name, &kernel.wgsl());
        let module = &checked.module;
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).expect("sizes");
        let of =
            |wanted: fn(AddressSpace) -> bool| module.global_variables.iter().filter(move |(_, v)| wanted(v.space));
        let storage = of(|space| matches!(space, AddressSpace::Storage { .. })).count();
        let shared: u32 = of(|space| space == AddressSpace::WorkGroup).map(|(_, v)| layouter[v.ty].size).sum();
        let uniform = of(|space| space == AddressSpace::Uniform).map(|(_, v)| layouter[v.ty].size).max();
        assert!(storage <= 8, "{}: {storage} storage buffers", kernel.name);
        assert!(shared <= 16_384, "{}: {shared} bytes of workgroup memory", kernel.name);
        assert!(uniform.unwrap_or(0) <= 65_536, "{}: a uniform of {uniform:?} bytes", kernel.name);
        let mut bindings: Vec<_> =
            module.global_variables.iter().filter_map(|(_, v)| v.binding).map(|b| (b.group, b.binding)).collect();
        bindings.sort_unstable();
        let expected: Vec<_> = (0..bindings.len() as u32).map(|binding| (0, binding)).collect();
        assert_eq!(bindings, expected, "{}: bindings are numbered from 0 without gaps", kernel.name);
    }
}

#[test]
fn structs_have_the_same_bytes_in_both_languages() {
    for kernel in KERNELS {
        let module = checked(kernel.name, &kernel.wgsl()).module;
        for Layout { name, size, fields } in LAYOUTS.into_iter().flatten() {
            let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
            let (_, ty) = found.unwrap_or_else(|| panic!("{}: no struct {name}", kernel.name));
            let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
            let offsets: Vec<_> =
                members.iter().map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize)).collect();
            let expected: Vec<_> = fields.iter().map(|(field, offset, _)| (*field, *offset)).collect();
            assert_eq!((offsets, *span as usize), (expected, *size), "{name}");
        }
    }
}

/// What the numerical contract leaves of WGSL: `+ - *` on f32, `abs`, `floor`, `round`, `select`, comparisons,
/// integers and bits. Returns every breach.
fn breaches(checked: &Checked) -> Vec<String> {
    let module = &checked.module;
    let mut found = Vec::new();
    for (_, ty) in module.types.iter() {
        match ty.inner {
            TypeInner::Matrix { .. } => found.push("a matrix type".to_owned()),
            ref inner if inner.scalar().is_some_and(|s| s.kind == ScalarKind::Float && s.width != 4) => {
                found.push("a float type that is not f32".to_owned());
            }
            TypeInner::Atomic(scalar) if scalar.kind == ScalarKind::Float => found.push("a float atomic".to_owned()),
            _ => {}
        }
    }
    let functions = module.functions.iter().map(|(handle, function)| (function, &checked.info[handle]));
    let entries = module.entry_points.iter().enumerate();
    let entries = entries.map(|(index, entry)| (&entry.function, checked.info.get_entry_point(index)));
    for (function, info) in functions.chain(entries) {
        let name = function.name.as_deref().unwrap_or("the entry point");
        let is_float = |handle: Handle<Expression>| {
            info[handle].ty.inner_with(&module.types).scalar().is_some_and(|scalar| scalar.kind == ScalarKind::Float)
        };
        for (_, expression) in function.expressions.iter() {
            if let Some(breach) = breach(expression, is_float) {
                found.push(format!("{breach} in `{name}`"));
            }
        }
        statements(function, &mut |statement| {
            if let Some(breach) = group_operation(statement) {
                found.push(format!("{breach} in `{name}`"));
            }
        });
    }
    for (_, expression) in module.global_expressions.iter() {
        if let Expression::Math { fun, .. } = expression {
            found.push(format!("{fun:?} in a constant"));
        }
        if let Expression::Binary { op: BinaryOperator::Divide | BinaryOperator::Modulo, .. } = expression {
            found.push("a division in a constant".to_owned());
        }
    }
    found
}

fn breach(expression: &Expression, is_float: impl Fn(Handle<Expression>) -> bool) -> Option<String> {
    match expression {
        Expression::Binary { op: op @ (BinaryOperator::Divide | BinaryOperator::Modulo), left, .. }
            if is_float(*left) =>
        {
            Some(format!("float {op:?}"))
        }
        Expression::Math { fun, arg, .. } => {
            use MathFunction as M;
            let allowed = if is_float(*arg) {
                matches!(fun, M::Abs | M::Floor | M::Round)
            } else {
                matches!(fun, M::Abs | M::Min | M::Max | M::CountTrailingZeros)
            };
            (!allowed).then(|| format!("{fun:?}"))
        }
        Expression::Derivative { .. } => Some("a derivative".to_owned()),
        Expression::Relational { fun, .. } => Some(format!("{fun:?}")),
        Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. } => {
            Some("a subgroup operation".to_owned())
        }
        Expression::ImageSample { .. } | Expression::ImageLoad { .. } => Some("an image".to_owned()),
        _ => None,
    }
}

fn group_operation(statement: &Statement) -> Option<&'static str> {
    match statement {
        Statement::SubgroupBallot { .. } | Statement::SubgroupCollectiveOperation { .. } => {
            Some("a subgroup operation")
        }
        Statement::SubgroupGather { mode: GatherMode::BroadcastFirst, .. } => Some("a subgroup broadcast"),
        Statement::SubgroupGather { .. } => Some("a subgroup gather"),
        _ => None,
    }
}

/// Visits every statement, nested ones included.
fn statements(function: &Function, visit: &mut impl FnMut(&Statement)) {
    fn walk(block: &naga::Block, visit: &mut impl FnMut(&Statement)) {
        for statement in block {
            visit(statement);
            match statement {
                Statement::Block(block) => walk(block, visit),
                Statement::If { accept, reject, .. } => {
                    walk(accept, visit);
                    walk(reject, visit);
                }
                Statement::Loop { body, continuing, .. } => {
                    walk(body, visit);
                    walk(continuing, visit);
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| walk(&case.body, visit)),
                _ => {}
            }
        }
    }
    walk(&function.body, visit);
}

#[test]
fn no_kernel_uses_a_forbidden_operation() {
    for kernel in KERNELS {
        let found = breaches(&checked(kernel.name, &kernel.wgsl()));
        assert!(found.is_empty(), "{}: {found:?}", kernel.name);
    }
}

/// The check above would notice: each of these lines breaks the contract in one way.
#[test]
fn every_kind_of_forbidden_operation_is_noticed() {
    let operations = [
        "x / y",
        "x % y",
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "exp(x)",
        "exp2(x)",
        "log(x)",
        "log2(x)",
        "tanh(x)",
        "pow(x, y)",
        "sqrt(x)",
        "inverseSqrt(x)",
        "atan2(x, y)",
        "fma(x, y, x)",
        "mix(x, y, x)",
        "min(x, y)",
        "max(x, y)",
        "clamp(x, y, x)",
        "sign(x)",
        "fract(x)",
        "trunc(x)",
        "ceil(x)",
        "radians(x)",
        "dot(vec2(x, y), vec2(y, x))",
        "length(vec2(x, y))",
        "distance(x, y)",
        "normalize(vec2(x, y)).x",
        "smoothstep(x, y, x)",
        "step(x, y)",
        "f32(clamp(u32(x), 1u, 2u))",
        "(mat2x2<f32>(x, y, x, y) * vec2(x, y)).x",
    ];
    for operation in operations {
        let wgsl = format!(
            "@group(0) @binding(0) var<storage, read_write> data: array<f32>;\n\
             fn inner(x: f32, y: f32) -> f32 {{ if x > y {{ return {operation}; }} return x; }}\n\
             @compute @workgroup_size(32) fn main() {{ data[0] = inner(data[1], data[2]); }}"
        );
        assert!(!breaches(&checked(operation, &wgsl)).is_empty(), "{operation} was not noticed");
    }
    for operation in ["x + y", "x - y", "x * y", "-x", "abs(x)", "floor(x)", "round(x)", "f32(u32(x) / 3u)"] {
        let wgsl = format!(
            "@group(0) @binding(0) var<storage, read_write> data: array<f32>;\n\
             @compute @workgroup_size(32) fn main() {{ let x = data[1]; let y = data[2]; data[0] = {operation}; }}"
        );
        assert_eq!(breaches(&checked(operation, &wgsl)), Vec::<String>::new(), "{operation} is allowed");
    }
}

/// Some breaches do not even get past validation, which knows no extension of WGSL.
#[test]
fn extensions_are_refused() {
    let sources = [
        "enable f16; @compute @workgroup_size(32) fn main() { let x = 1.0h; }",
        "@compute @workgroup_size(32) fn main() { let x = 1.0lf; }",
        "enable subgroups; @compute @workgroup_size(32) fn main() { let x = subgroupAdd(1.0f); }",
        "var<workgroup> sum: atomic<f32>; @compute @workgroup_size(32) fn main() { atomicAdd(&sum, 1.0f); }",
        "var<immediate> x: u32; @compute @workgroup_size(32) fn main() { let y = x; }",
    ];
    for wgsl in sources {
        assert!(check(wgsl).is_err(), "{wgsl}");
    }
}
