// Plays recordings and random scenes in a module made for wasm32-unknown-unknown: the same file in Node and in a page.

/// The lines of all recordings, `[name, bytes]` each, and of all scenes.
export async function streams(module, replays) {
  const { instance } = await WebAssembly.instantiate(module, {});
  const { memory, tamias_room, tamias_golden, tamias_scenes, tamias_scene, tamias_answer } = instance.exports;
  const lines = (length) => {
    const text = new TextDecoder().decode(new Uint8Array(memory.buffer, tamias_answer(), length));
    if (text.startsWith("!")) throw new Error(text.slice(1));
    return text;
  };
  let all = "";
  for (const [name, bytes] of replays) {
    // The memory may be another one after each call.
    const at = tamias_room(bytes.length);
    new Uint8Array(memory.buffer).set(bytes, at);
    // The module does not know the name.
    all += lines(tamias_golden()).replace(/^/gm, name).slice(0, -name.length);
  }
  for (let seed = 1; seed <= tamias_scenes(); seed += 1) all += lines(tamias_scene(seed));
  return all;
}
