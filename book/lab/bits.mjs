// Runs every shipped scene as built for debug, for release, for this processor, and as the page's
// WebAssembly, and compares the digests of their histories: node book/lab/bits.mjs
//
// Writes data/bits/digests.csv and data/bits/platforms.csv; fails where two differ.
import { execFileSync } from "node:child_process";
import { cpus } from "node:os";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import path from "node:path";

const root = path.resolve(import.meta.dirname, "../..");
const run = (command, args, more = {}) =>
  execFileSync(command, args, { cwd: root, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"], ...more });
// FNV-1a of 64 bits.
function digest(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return hash.toString(16).padStart(16, "0");
}
const scenes = readdirSync(path.join(root, "data/scenes")).filter((file) => file.endsWith(".toml")).sort();

// The digests of a native program, built with these arguments of cargo and flags of rustc.
function native(folder, args, flags) {
  const env = { ...process.env, ...(flags ? { RUSTFLAGS: flags } : {}) };
  const target = path.join(root, "target", folder);
  run("cargo", ["build", "--quiet", "--locked", "--package", "lme-mpm-lab", "--bin", "bits", "--target-dir", target, ...args], { env });
  const lines = run(path.join(target, args.length ? "release" : "debug", "bits"), []).trim().split("\n");
  const digests = new Map(lines.map((line) => line.split(",")));
  return (scene) => digests.get(scene.replace(".toml", ""));
}

// The page's solver in this program's own engine.
function page() {
  const module = new WebAssembly.Module(readFileSync(path.join(root, "book/lab/lab.wasm")));
  return (scene) => {
    const { alloc, history, memory } = new WebAssembly.Instance(module, {}).exports;
    const request = Buffer.from(`0\0${readFileSync(path.join(root, "data/scenes", scene), "utf8")}`);
    const at = alloc(request.length);
    new Uint8Array(memory.buffer).set(request, at);
    const answer = history(at, request.length), view = new DataView(memory.buffer);
    const end = answer + 4 + view.getUint32(answer, true);
    for (let next = answer + 4; next < end;) {
      const [name, content] = [0, 0].map(() => {
        const length = view.getUint32(next, true);
        next += 4 + length;
        return Buffer.from(memory.buffer.slice(next - length, next));
      });
      if (name.toString() === "csv") return digest(content);
      if (name.toString() === "error") throw new Error(`${scene}: ${content}`);
    }
    throw new Error(`${scene}: no history`);
  };
}

const rustc = run("rustc", ["--version"]).trim().replace(/ \(.*/, "");
const processor = cpus()[0].model.replace(/,/g, " ").trim();
const machine = `${process.arch} ${process.platform}`;
const platforms = [
  ["debug", `${rustc}; ${machine}`, native(".", [])],
  ["release", `${rustc}; ${machine}`, native("bits", ["--release"])],
  ["release with target-cpu=native", `${rustc}; ${machine}; ${processor}`, native("native", ["--release"], "-C target-cpu=native")],
  ["WebAssembly", `book/lab/lab.wasm in V8 ${process.versions.v8.replace(/-.*/, "")} of Node ${process.version}`, page()],
];
const digests = platforms.map(([, , of]) => scenes.map(of));
const differ = scenes.filter((_, n) => digests.some((own) => own[n] !== digests[0][n]));
mkdirSync(path.join(root, "data/bits"), { recursive: true });
const csv = (rows) => rows.map((row) => row.join(",")).join("\n") + "\n";
writeFileSync(path.join(root, "data/bits/digests.csv"), csv([["scene", "digest of history.csv"], ...scenes.map((scene, n) => [scene, digests[0][n]])]));
writeFileSync(path.join(root, "data/bits/platforms.csv"), csv([
  ["built as", "with", "scenes", "as in debug"],
  ...platforms.map(([name, version], i) => [name, version, scenes.length, scenes.filter((_, n) => digests[i][n] === digests[0][n]).length]),
]));
if (differ.length) throw new Error(`histories differ: ${differ}`);
console.log(`bits: ${scenes.length * platforms.length} passed, 0 failed`);
