//! Chain files: valid input, and all errors.

use super::*;

fn read(text: &str) -> Result<ChainFile, Diagnostics> {
    ChainFile::read(SourceText::new("folder/c.toml", text))
}

fn printed(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

#[test]
fn defaults_are_the_published_module() {
    let file = read("name = 'x'").unwrap();
    assert_eq!((file.modules, file.body, file.folding.is_none()), (12, ModuleDimensions::default(), true));
    let file = read("[sequence]\nname = 'block'\nreading = 'B'\n[chain]\njoint_sigma = '1 deg'").unwrap();
    let folding = file.folding.unwrap();
    assert_eq!((file.modules, folding.shape), (6, Some(ChainShape::Block { reading: Reading::Tail })));
    assert!((file.errors.joint_sigma - 0.017_453).abs() < 1e-6);
    let file = read("[chain]\npitch = 50\nface = '2 cm'\n[connector]\ndesign = 'x.toml'").unwrap();
    assert_eq!((file.body.overhang, file.body.face), (25.0, 20.0));
    assert_eq!(file.connector.unwrap().path, PathBuf::from("folder/x.toml"));
}

#[test]
fn own_steps_fold_onto_a_lattice_of_their_own() {
    let step = |time: f64, joint: usize, command: &str| {
        format!("[[step]]\ntime = {time}\njoint = {joint}\ncommand = {command}\n")
    };
    let fold = [step(0.0, 4, "0"), step(1.0, 4, "-1.67"), step(1.0, 5, "'-95 deg'"), step(2.0, 5, "'slack'")]
        .concat();
    let file = read(&format!("[chain]\nmodules = 6\n[sequence]\nlatches = '3-6'\n{fold}")).unwrap();
    let folding = file.folding.unwrap();
    assert_eq!(folding.lattice, ChainShape::P.angles());
    assert_eq!(folding.sequence.steps.len(), 3);
    assert_eq!(folding.sequence.latches.len(), 1);
    assert_eq!(folding.sequence.steps[1].commands.len(), 2);
    let wrong = printed(&format!("[chain]\nmodules = 6\n[sequence]\nlatches = '2-6'\n{fold}"));
    assert!(wrong.contains("`2-6` are no two modules") && wrong.contains("those that do: 3-6"), "{wrong}");
}

#[test]
fn everything_wrong_is_reported_in_its_place() {
    let text = "[chain]\nmodules = 6\n[[step]]\ntime = 1\njoint = 9\ncommand = 0\n[[step]]\ntime = 1\njoint = 2\n\
                command = 'slack'\n[[step]]\ntime = 0\njoint = 2\ncommand = 'slakc'\n[[step]]\ntime = 0.5\njoint = 2\ncommand = 1\n";
    let all = printed(text);
    for wanted in [
        "c.toml:5:9: joint 9 does not exist; the chain has joints 1 to 6",
        "c.toml:10:11: joint 2 goes slack without an earlier command",
        "c.toml:14:11: `slakc` is neither an angle nor \"slack\"",
        "c.toml:16:8: time goes back from 1 s to 0.5 s",
    ] {
        assert!(all.contains(wanted), "{wanted}: {all}");
    }
    assert!(
        printed("[sequence]\nname = 'P'\n[chain]\nmodules = 7").contains("P is folded from 6 modules, not 7")
    );
    assert!(printed("[sequence]\nname = 'P'\nreading = 'A'").contains("is for name = \"Block\" alone"));
    assert!(printed("[sequence]\nname = 'Q'").contains("cannot be \"Q\""));
    assert!(printed("[sequence]\n").contains("names no shape"));
    assert!(printed("[connector]\nrotation_length = 1").contains("`connector.design` is missing"));
    assert!(printed("[chain]\nlength = 96").contains("do not fit a pitch"));
    assert!(printed("[[step]]\ntime = 0\njoint = 1\n").contains("`step[0].command` is missing"));
    assert!(printed("[[step]]\ntime = 0\njoint = 1\ncommand = 7").contains("`step[0].command` is 7"));
}
