// Runs every shipped scene as built for debug, for release, for this processor, for three other
// processors, and as the page's WebAssembly by two compilers, and compares the digests of their
// histories:
// node book/lab/bits.mjs [--without NAME]...
//
// Fails where two differ; else writes data/bits/digests.csv and data/bits/platforms.csv. What
// another processor or compiler needs is named where it is missing; --without aarch64, say, leaves
// that one out.
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

// The digests that the program `bits` prints, built with these arguments of cargo and variables of
// the environment; `engine` runs what this processor cannot.
function program(folder, args, env = {}, engine = []) {
  const target = path.join(root, "target", folder);
  run("cargo", ["build", "--quiet", "--locked", "--package", "lme-mpm-lab", "--bin", "bits", "--target-dir", target, ...args], { env: { ...process.env, ...env } });
  const triple = args.includes("--target") ? args[args.indexOf("--target") + 1] : "";
  const bits = path.join(target, triple, args.includes("--release") ? "release" : "debug", "bits");
  const [command, ...rest] = [...engine, bits];
  const digests = new Map(run(command, rest).trim().split("\n").map((line) => line.split(",")));
  return (scene) => digests.get(scene.replace(".toml", ""));
}

// Another processor: what rustc calls it, what links for it, and what runs it here. Without
// `engine` this machine runs it itself.
const PROCESSORS = {
  i686: { triple: "i686-unknown-linux-musl", linker: "rust-lld", words: "32 bits" },
  aarch64: { triple: "aarch64-unknown-linux-musl", linker: "rust-lld", engine: "qemu-aarch64", words: "64 bits" },
  s390x: { triple: "s390x-unknown-linux-gnu", linker: "s390x-linux-gnu-gcc", engine: "qemu-s390x", flags: "-C target-feature=+crt-static", words: "64 bits with the largest byte first" },
};
function processor(name) {
  const { triple, linker, engine, flags, words } = PROCESSORS[name];
  const key = `CARGO_TARGET_${triple.toUpperCase().replaceAll("-", "_")}`;
  const env = { [`${key}_LINKER`]: linker, ...(flags ? { [`${key}_RUSTFLAGS`]: flags } : {}) };
  const emulator = engine ? `; ${run(engine, ["--version"]).match(/qemu-\S+ version [\d.]+/)[0]}` : "";
  return [name, `${rustc}; ${triple}: ${words}${emulator}`, program("bits", ["--release", "--target", triple], env, engine ? [engine] : [])];
}

// The page's solver by the compiler of the system, whose standard library is compiled from source.
function system() {
  const env = { ...process.env, PATH: "/usr/bin:/bin", RUSTC_BOOTSTRAP: "1", CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER: "wasm-ld" };
  const target = "wasm32-unknown-unknown";
  run("/usr/bin/cargo", ["build", "--quiet", "--locked", "--package", "lme-mpm-lab", "--lib", "--profile", "lab", "--target", target, "--target-dir", "target/system", "-Zbuild-std=std,panic_abort"], { env });
  return ["WebAssembly from source", `${version("/usr/bin/rustc")} with -Zbuild-std; V8 ${v8}`, page(`target/system/${target}/lab/lme_mpm_lab.wasm`)];
}

const OTHERS = {
  ...Object.fromEntries(Object.keys(PROCESSORS).map((name) => [name, () => processor(name)])),
  system,
};
const NEEDS = "rustup target add i686-unknown-linux-musl aarch64-unknown-linux-musl s390x-unknown-linux-gnu; "
  + "of Debian's packages qemu-user, gcc-s390x-linux-gnu, libc6-dev-s390x-cross for the processors, "
  + "cargo-web, rustc-web, rust-web-src, lld for the system's compiler";
function other(name) {
  try {
    return OTHERS[name]();
  } catch (fault) {
    throw new Error(`${name} was not run. These are needed: ${NEEDS}. --without ${name} leaves it out`, { cause: fault });
  }
}

// The page's solver in this program's own engine.
function page(file) {
  const module = new WebAssembly.Module(readFileSync(path.join(root, file)));
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

const version = (rustc) => run(rustc, ["--version"]).trim().replace(/ \(.*/, "").replace(/.*\//, "");
const rustc = version("rustc"), v8 = process.versions.v8.replace(/-.*/, "");
const model = cpus()[0].model.replace(/,/g, " ").trim();
const machine = `${process.arch} ${process.platform}`;
const without = process.argv.slice(2).filter((word) => word !== "--without");
for (const name of without) if (!(name in OTHERS)) throw new Error(`--without ${name}: there are ${Object.keys(OTHERS).join(", ")}`);
const platforms = [
  ["debug", `${rustc}; ${machine}`, program(".", [])],
  ["release", `${rustc}; ${machine}`, program("bits", ["--release"])],
  ["release with target-cpu=native", `${rustc}; ${machine}; ${model}`, program("native", ["--release"], { RUSTFLAGS: "-C target-cpu=native" })],
  ["WebAssembly", `${rustc}; book/lab/lab.wasm in V8 ${v8} of Node ${process.version}`, page("book/lab/lab.wasm")],
  ...Object.keys(OTHERS).filter((name) => !without.includes(name)).map(other),
];
const digests = platforms.map(([, , of]) => scenes.map(of));
const differ = scenes.filter((_, n) => digests.some((own) => own[n] !== digests[0][n]));
if (differ.length) throw new Error(`histories differ: ${differ}`);
mkdirSync(path.join(root, "data/bits"), { recursive: true });
const csv = (rows) => rows.map((row) => row.join(",")).join("\n") + "\n";
writeFileSync(path.join(root, "data/bits/digests.csv"), csv([["scene", "digest of history.csv"], ...scenes.map((scene, n) => [scene, digests[0][n]])]));
writeFileSync(path.join(root, "data/bits/platforms.csv"), csv([
  ["built as", "with", "scenes", "as in debug"],
  ...platforms.map(([name, version], i) => [name, version, scenes.length, scenes.filter((_, n) => digests[i][n] === digests[0][n]).length]),
]));
console.log(`bits: ${scenes.length * platforms.length} passed, 0 failed`);
