use lme_mpm::*;
fn main() {
    let cells: usize = std::env::args().nth(1).and_then(|x| x.parse().ok()).unwrap_or(40);
    let s = scene::Scene::parse("dyka","dyka.toml",scene::DYKA,&[format!("grid.cells={cells}")]).unwrap_or_else(|e|panic!("{e}"));
    let t=std::time::Instant::now();
    let o = run::run(&s, &mut |_|{}).unwrap_or_else(|e|panic!("{}",e.breakdown));
    for l in summary::lines(&s,&o,t.elapsed().as_secs_f64()) { println!("{:40} {:e} {}",l.quantity,l.value,l.unit); }
    for l in summary::cost_lines(&o.cost) { println!("{:40} {} {}",l.quantity,l.value,l.unit); }
}
