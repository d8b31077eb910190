//! `dump_scenes DIR`: writes every scene as DIR/GROUP.NAME.json.

fn main() {
    let dir = std::env::args().nth(1).expect("usage: dump_scenes DIR");
    std::fs::create_dir_all(&dir).expect("DIR can be made");
    for scene in peer_scenes::all() {
        let path = format!("{dir}/{}.{}.json", scene.group, scene.name);
        std::fs::write(&path, scene.to_json()).expect("DIR can be written to");
        println!("{path}: {} bodies, {} steps", scene.bodies.len(), scene.steps);
    }
}
