//! The GPU backend on whatever adapter this machine has, software included.
use skilltree::backend::gpu::{adapter, conformance, device::Device};
#[test]
fn exact() {
    let t = std::time::Instant::now();
    let adapter = adapter::choose(None, true).unwrap();
    eprintln!("{:?} {:?}", t.elapsed(), adapter.get_info());
    let device = Device::open(&adapter).unwrap();
    eprintln!("{:?} open", t.elapsed());
    let v = conformance::examine(&device).unwrap();
    eprintln!("{:?} {:?}", t.elapsed(), v);
    let v = conformance::examine(&device).unwrap();
    eprintln!("{:?} {:?}", t.elapsed(), v);
}
