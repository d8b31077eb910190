// node play.mjs MODULE.wasm REPLAYS [BROWSER]: the lines on standard output, played by Node, or by a browser without a
// window that gets a page from here and sends back what it found.

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { streams } from "./streams.mjs";

const [file, folder, browser] = process.argv.slice(2);
const names = readdirSync(folder).filter((name) => name.endsWith(".replay")).map((name) => name.slice(0, -7)).sort();
const replay = (name) => readFileSync(join(folder, `${name}.replay`));

const PAGE = `<!doctype html><meta charset="utf-8"><title>streams</title><script type="module">
  import { streams } from "./streams.mjs";
  const bytes = async (path) => new Uint8Array(await (await fetch(path)).arrayBuffer());
  try {
    const replays = [];
    for (const name of ${JSON.stringify(names)}) replays.push([name, await bytes("replay/" + name)]);
    await fetch("found", { method: "POST", body: await streams(await bytes("module"), replays) });
  } catch (error) {
    await fetch("failed", { method: "POST", body: String(error) });
  }
</script>`;

/// What a browser finds. It reports itself; when it ends or says nothing, the caller's patience ends this program.
function byBrowser() {
  const profile = mkdtempSync(join(tmpdir(), "streams-"));
  const quiet = ["--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-extensions"];
  // As root there is no sandbox; the page is our own.
  const sandbox = process.getuid() === 0 ? ["--no-sandbox"] : [];
  return new Promise((resolve, reject) => {
    const server = createServer((request, response) => {
      const send = (type, body) => response.writeHead(200, { "content-type": type }).end(body);
      const path = request.url.slice(1);
      if (path === "") send("text/html", PAGE);
      else if (path === "streams.mjs") send("text/javascript", readFileSync(new URL("streams.mjs", import.meta.url)));
      else if (path === "module") send("application/wasm", readFileSync(file));
      else if (path.startsWith("replay/") && names.includes(path.slice(7))) send("application/octet-stream", replay(path.slice(7)));
      else if (request.method === "POST") {
        const parts = [];
        request.on("data", (part) => parts.push(part)).on("end", () => {
          send("text/plain", "");
          const body = Buffer.concat(parts).toString();
          if (path === "found") resolve(body);
          else reject(new Error(body));
        });
      } else response.writeHead(404).end();
    });
    server.listen(0, "127.0.0.1", () => {
      const page = `http://127.0.0.1:${server.address().port}/`;
      const child = spawn(browser, ["--headless", ...sandbox, ...quiet, `--user-data-dir=${profile}`, page], { stdio: ["ignore", 2, 2] });
      child.on("error", reject).on("exit", (code) => reject(new Error(`${browser} ended with ${code}`)));
      process.on("exit", () => {
        child.kill("SIGKILL");
        rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
      });
    });
  });
}

const found = browser ? await byBrowser() : await streams(readFileSync(file), names.map((name) => [name, replay(name)]));
// All of it, before the program ends with whatever still runs.
process.stdout.write(found, () => process.exit(0));
