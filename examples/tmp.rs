#![allow(missing_docs)]
use skilltree::config::*; use skilltree::experiment::*; use skilltree::backend::cpu::CpuBackend;
use std::time::Instant;
fn main(){
  let args: Vec<String>=std::env::args().collect();
  let ov = Overrides{ set: args[3..].to_vec(), seeds: Some(args[2].clone()) };
  let plan = load(std::path::Path::new(&args[1]), &ov).unwrap_or_else(|e|{eprintln!("{e}");std::process::exit(2)});
  let t=Instant::now();
  let groups = group::groups(&plan).unwrap();
  eprintln!("setup {:.2?} groups {}", t.elapsed(), groups.len());
  let mut be = CpuBackend::new(0,None).unwrap();
  for g in &groups {
    let b=&g.bounds[0]; let ok=b.iter().filter(|d|d.achieved()).count();
    let st:u32=b.iter().map(|d|d.steps()).sum();
    eprintln!("planner success {:.3} steps {:.2} bytes/learner {}", ok as f64/b.len() as f64, st as f64/b.len() as f64, g.shape.bytes_per_learner());
    for arm in &g.arms {
    let ids:Vec<_>=g.learners(&plan).into_iter().filter(|l|l.arm==*arm).collect();
    let t=Instant::now();
    let mut res=vec![];
    for c in ids.chunks(32){ res.extend(train::train(&plan,g,c,&mut be,&mut |_|{}).unwrap()); }
    let el=t.elapsed();
    let up:u64=res.iter().map(|r|r.updates as u64).sum();
      println!("{} n={} {:.2?} updates {:.2}M  {:.2} M/s failed {}", plan.arms[*arm].name, res.len(), el, up as f64/1e6, up as f64/1e6/el.as_secs_f64(), res.iter().filter(|r|r.failed).count());
      let nt=res[0].tests.len();
      for k in 0..nt {
        let s:Vec<f64>=res.iter().map(|r|{let rs=&r.tests[k].rooms; rs.iter().map(|x|x.successes).sum::<u32>() as f64/rs.iter().map(|x|x.episodes).sum::<u32>() as f64}).collect();
        let st:f64=res.iter().map(|r|r.tests[k].rooms.iter().map(|x|x.steps).sum::<u32>() as f64).sum::<f64>()/(res.len() as f64*plan.evaluate.episodes as f64);
        let m=s.iter().sum::<f64>()/s.len() as f64; let low=s.iter().filter(|x|**x<0.5).count();
        println!("   {:4} trials: {:.3}  min {:.2} <0.5: {} steps {:.1} actions {}", res[0].tests[k].trials, m, s.iter().cloned().fold(1.0,f64::min), low, st, res[0].tests[k].actions);
      }
    }
  }
}
