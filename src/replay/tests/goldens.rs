//! Each committed recording, played without the program: what changes a bit of any tick ends here.

use crate::replay::Player;
use crate::{Commands, World};
use std::path::Path;

/// Plays a recording to its end. Every 50th tick the world's invariants hold, and a world that is loaded from its save goes on
/// with the same bits.
fn play(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("replays").join(name).with_extension("replay");
    let file = std::fs::read(path).expect("committed");
    let mut player = Player::new(&file[..]).expect("a replay");
    let mut twin: Option<World> = None;
    loop {
        let played = player.step().unwrap_or_else(|error| panic!("{name}: {error}"));
        let Some(hash) = played else { break };
        if let Some(twin) = &mut twin {
            for command in player.commands() {
                twin.apply(command).expect("accepted once");
            }
            twin.step();
            assert_eq!(twin.hash(), hash, "{name}: tick {}, loaded a tick ago", player.ticks());
        }
        twin = None;
        if player.ticks() % 50 == 0 {
            player.world().check().unwrap_or_else(|reason| panic!("{name}: tick {}: {reason}", player.ticks()));
            twin = Some(World::load(&player.world().save()).expect("a save"));
        }
    }
    assert!(player.ticks() > 0);
}

macro_rules! goldens {
    ($($name:ident)*) => {$(
        #[test]
        fn $name() {
            play(stringify!($name));
        }
    )*

    #[test]
    fn none_is_forgotten() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("replays");
        let files = folder.read_dir().expect("a folder").filter_map(|entry| Some(entry.ok()?.path()));
        let replays = files.filter(|path| path.extension().is_some_and(|extension| extension == "replay"));
        let mut names: Vec<_> = replays.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
        names.sort();
        assert_eq!(names, [$(stringify!($name)),*]);
    }};
}

goldens! {
    bouncers churn everything free_flight orbit pile300 pixels pusher pyramid55 sensors sleep spin tc10c tc11c tumbler
}
