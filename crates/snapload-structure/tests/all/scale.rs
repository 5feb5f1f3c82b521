//! One structure at two sizes.

use snapload::analysis::no_progress;
use snapload_structure::{Assessment, Lines, Structure, VerdictKind, seas};

/// A cylinder that just snaps, with all lengths `scale` times as large and, by Froude, times by
/// its root, masses and forces by its third power; in waves that are given.
fn cylinder(scale: f64, water: &str) -> Structure {
    let (time, force) = (scale.sqrt(), scale.powi(3));
    let line = |anchor: f64, fairlead: f64, length: f64, stiffness: f64, mass: f64, load: f64| {
        format!(
            "[[line]]\nanchor = [{}, {}]\nfairlead = [{}, {}]\nlength = {}\nstiffness = {}\n\
             mass_per_length = {}\nbreaking_load = {}\n",
            anchor * scale,
            -13.525_391_809_384_626 * scale,
            fairlead * scale,
            -4.153_321_151_648_296 * scale,
            length * scale,
            stiffness * force,
            mass * scale * scale,
            load * force,
        )
    };
    let text = format!(
        "[body]\nwidth = {}\ndisplaced_volume = {}\nmass = {}\nposition = [{}, {}]\n\
         moment_of_inertia = {}\nturning_damping = {}\n{}{}{}{}[site]\ndepth = {}\ngravity = 9.8\n\
         {water}[run]\nrestitution = 0.3\nduration = {}\ntransient = {}\n",
        2.882_743_344_052_717_5 * scale,
        76.640_276_709_754_15 * force,
        38_742.562_148_583_96 * force,
        0.707_753_307_807_308_4 * scale,
        -3.144_360_981_229_844_8 * scale,
        80_489.698_980_359 * force * scale * scale,
        20_174.903_586_765_526 * force * scale * scale / time,
        line(
            8.496_088_175_798_494,
            1.185_148_398_711_964_6,
            11.788_794_484_018_43,
            168_250_553.115_472_05,
            23.872_638_292_835_703,
            5e5
        ),
        line(
            -8.727_780_384_711_712,
            0.342_796_620_331_258_7,
            12.832_352_594_257_1,
            59_865_553.485_856_62,
            2.636_724_559_035_474,
            1e6
        ),
        line(
            3.969_551_556_965_009_3,
            1.557_817_948_080_699_3,
            9.491_729_525_354_533,
            39_672_448.999_583_87,
            12.937_648_499_770_225,
            1e6
        ),
        line(
            -8.705_550_795_868_572,
            0.065_540_485_227_095_32,
            12.724_657_998_557_541,
            94_684_709.312_056_75,
            28.430_058_665_575_5,
            1e6
        ),
        13.525_391_809_384_626 * scale,
        60.0 * time,
        10.0 * time,
    );
    Structure::parse("case", &text).unwrap()
}

/// Of one structure at full size and at 1:64 the same line breaks, at the same
/// ratio to its breaking load, although at the smaller size all snaps are slower
/// than 1 cm/s and none is counted.
#[test]
fn a_model_breaks_where_the_full_size_does() {
    let run = |scale: f64| {
        let (height, period) = (1.084_387_628_629_211_8, 5.992_548_929_200_369);
        let (height, period) = (height * scale, period * scale.sqrt());
        let wave = format!("[wave]\nheight = {height}\nperiod = {period}\ndirection = \"-x\"\n");
        Assessment::single_run(cylinder(scale, &wave), &no_progress).unwrap()
    };
    let [full, model] = [run(1.0), run(1.0 / 64.0)];
    let parts = |run: &Assessment| run.outcome.utilisations(&run.prepared.structure);
    for (full, model) in parts(&full).into_iter().zip(parts(&model)) {
        let (full, model) = (full.unwrap(), model.unwrap());
        assert!((full - model).abs() <= 1e-9 * full, "{full} {model}");
    }
    assert!(full.outcome.snaps() > 0);
    assert_eq!(model.outcome.snaps(), 0);
    let verdict = model.verdict();
    assert_eq!(verdict.standing, full.verdict().standing);
    assert_eq!(verdict.standing, VerdictKind::Breaks, "{}", verdict.words);
    assert!(
        verdict.words.contains("in a slower snap"),
        "{}",
        verdict.words
    );
    assert!(
        model
            .summary("case")
            .contains("kN in slower ones than 1 cm/s")
    );
}

/// Records of a sea have the same distribution of the largest tension at full size and at 1:32,
/// although at the smaller size all snaps of some records are slower than 1 cm/s.
#[test]
fn records_of_a_model_have_the_distribution_of_the_full_size() {
    let records = |scale: f64| {
        let sea = format!("[sea]\nhs = {}\ntp = {}\n", 0.4 * scale, 6.0 * scale.sqrt());
        seas(cylinder(scale, &sea), 3, Lines::Inextensible, &no_progress).unwrap()
    };
    let [full, model] = [records(1.0), records(1.0 / 32.0)];
    assert!(full.speeds_m_s().iter().all(|speed| speed.unwrap() > 0.01));
    assert!(model.speeds_m_s().contains(&Some(0.0)));
    let reason = model.speed_in_three_hours().unwrap_err().to_string();
    assert!(
        reason.contains("no line snaps at 1 cm/s or more"),
        "{reason}"
    );
    // By the laws of Froude; the three hours are not scaled.
    let [full, model] = [full, model].map(|seas| seas.peak_in_three_hours().unwrap());
    let force = 32.0_f64.powi(3);
    assert!((model.location * force / full.location - 1.0).abs() < 1e-6);
    assert!((model.scale * force / full.scale - 1.0).abs() < 1e-6);
}
