#![allow(clippy::all, clippy::pedantic, missing_docs)]
#[path = "common/fit_problems.rs"]
mod fit_problems;
use fit_problems::{Case, brdf_cases, cases};
use pbrdf::fit::{Observer, Starts, fit, with_intervals};
use std::collections::BTreeMap;
use std::time::Instant;

fn known() -> BTreeMap<String, f64> {
    std::fs::read_to_string("/tmp/lab/known.csv")
        .unwrap_or_default()
        .lines()
        .map(|l| {
            let (a, b) = l.split_once(',').unwrap();
            (a.to_owned(), b.parse().unwrap())
        })
        .collect()
}

fn run(name: &str, cases: Vec<Case>, full: bool, known: &mut BTreeMap<String, f64>) {
    let mut behind = vec![];
    let mut behind_full = vec![];
    let (mut evaluations, mut time, mut worst) = (0, 0.0, 0.0f64);
    for case in &cases {
        let problem = case.problem();
        let t = Instant::now();
        let result = fit(&problem, Starts::Automatic, 1, Observer::NONE);
        let ms = t.elapsed().as_secs_f64() * 1e3;
        time += ms;
        worst = worst.max(ms);
        evaluations += result.course.evaluations;
        let value = result.statistics.rss;
        let entry = known.entry(case.name.clone()).or_insert(f64::INFINITY);
        if full {
            let many = fit(&problem, Starts::Exactly(4000), 1, Observer::NONE).statistics.rss;
            *entry = entry.min(many);
        }
        let mut end = value;
        if full || value > *entry * (1.0 + 1e-6) {
            end = with_intervals(&problem, result, Observer::NONE).statistics.rss;
        }
        let ref_value = (*entry).min(end).min(value);
        *entry = ref_value;
        if value > ref_value * (1.0 + 1e-6) && value > 1e-20 {
            behind.push(format!("{} {:+.1e}", case.name, value / ref_value - 1.0));
        }
        if end > ref_value * (1.0 + 1e-6) && end > 1e-20 {
            behind_full.push(format!("{} {:+.1e}", case.name, end / ref_value - 1.0));
        }
    }
    println!(
        "{name}: {} problems, {} evaluations, {time:.0} ms in all, worst {worst:.0} ms; search behind {}: {behind:?}; with intervals behind {}: {behind_full:?}",
        cases.len(),
        evaluations,
        behind.len(),
        behind_full.len()
    );
}

#[test]
fn lab() {
    let mut known = known();
    let full = std::env::var("FULL").is_ok();
    run("dolp 2026", cases(2026, 4), full, &mut known);
    run("dolp 7", cases(7, 4), full, &mut known);
    run("brdf 3", brdf_cases(3, 3), full, &mut known);
    let text: String = known.iter().map(|(a, b)| format!("{a},{b:e}\n")).collect();
    std::fs::write("/tmp/lab/known.csv", text).unwrap();
}

#[test]
fn one() {
    let name = std::env::var("CASE").unwrap_or_default();
    if name.is_empty() {
        return;
    }
    let seed: u64 = name.split('-').next().unwrap().parse().unwrap();
    let all = if seed == 3 { brdf_cases(3, 3) } else { cases(seed, 4) };
    let case = all.iter().find(|c| c.name == name).unwrap();
    let problem = case.problem();
    println!("truth {:?}", case.truth);
    let r = fit(&problem, Starts::Automatic, 1, Observer::NONE);
    println!("search {:e} {:?}", r.statistics.rss, r.parameters);
    for m in &r.course.minima {
        println!("   {:e} hits {}", m.objective, m.hits);
    }
    let w = with_intervals(&problem, r.clone(), Observer::NONE);
    println!("intervals {:e} {:?}", w.statistics.rss, w.parameters);
    for n in [96, 128, 1000, 4000] {
        let m = fit(&problem, Starts::Exactly(n), 1, Observer::NONE);
        println!("{n} {:e} {:?}", m.statistics.rss, m.parameters);
    }
}

#[test]
fn seeds() {
    let known = known();
    let all: Vec<Case> = cases(2026, 4).into_iter().chain(cases(7, 4)).chain(brdf_cases(3, 3)).collect();
    for case in &all {
        let problem = case.problem();
        let best = known[&case.name];
        let values: Vec<f64> = (1..=4).map(|seed| fit(&problem, Starts::Automatic, seed, Observer::NONE).statistics.rss).collect();
        let behind = |v: f64| v > best * (1.0 + 1e-6) && v > 1e-20;
        if values.iter().any(|&v| behind(v)) {
            println!("{} {:?}", case.name, values.iter().map(|&v| if behind(v) { format!("{:+.1e}", v / best - 1.0) } else { "ok".into() }).collect::<Vec<_>>());
        }
    }
}

#[test]
fn perf() {
    use pbrdf::{Fit, Measurement, Model};
    let n: usize = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    let mut ms = vec![];
    let mut ev = 0;
    for i in 1..=10 {
        let data = Measurement::read(std::fs::File::open(format!("/tmp/lab/s{i}.csv")).unwrap()).unwrap();
        let mut best = f64::INFINITY;
        for _ in 0..n {
            let t = Instant::now();
            let r = Fit::new(&data, Model::CAUCHY).intervals(pbrdf::fit::Intervals::Linear).run().unwrap();
            best = best.min(t.elapsed().as_secs_f64() * 1e3);
            ev += r.course.evaluations;
        }
        ms.push(best);
    }
    println!("{ms:.1?} {}", ev / n / 10);
}
