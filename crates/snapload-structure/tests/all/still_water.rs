//! Notes on structures in still water.

use crate::verdicts::{source, structure};
use snapload::analysis::no_progress;
use snapload_structure::{assess, note};

/// A body that hangs on one line, which does not move without waves.
const TETHERED: &str = "\
[body]\nshape = \"circle\"\nwidth = 3\ndisplaced_volume = 141.37\nmass = 72452\nadded_mass = 144904\n\
moment_of_inertia = 163017\nposition = [0, -3.5]\n\
[[line]]\nanchor = [0.0, -10]\nfairlead = [0, -5.0]\nlength = 5.0\nstiffness = 1e8\n\
[site]\ndepth = 10\n";

/// Nothing is said of waves or of a time that is not judged where there are none, and rounding is
/// no rotation.
#[test]
fn a_note_on_still_water_says_nothing_of_waves() {
    let page = |more: &str| {
        let case = format!("{TETHERED}{more}[run]\nrestitution = 0.5\nduration = 60\n");
        let assessment = assess(structure(&case), 0, &no_progress).unwrap();
        note::page(source("case"), &assessment, None).unwrap()
    };
    let still = page("");
    let of_waves = ["The same waves", "not judged", "×10⁻¹⁵"];
    for words in of_waves {
        assert!(!still.contains(&format!("{words}<")) && !still.contains(&format!("{words} ")));
    }
    assert!(still.contains("The same run with a lower"));
    let moved = page("[wave]\nheight = 0.5\nperiod = 6\n");
    assert!(moved.contains("The same waves with a lower") && moved.contains(" are not judged"));
}
