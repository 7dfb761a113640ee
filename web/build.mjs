// Makes the package and the page from the module: node web/build.mjs MODULE-FOLDER OUTPUT-FOLDER
//
//   OUTPUT/package/   snug.js, snug.wasm, snug.simd.wasm, snug.d.ts and what else npm publishes
//   OUTPUT/snug.html  the page: one file, which needs no network

import { build } from "esbuild";
import { cp, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [module_folder, output] = process.argv.slice(2);

const common = {
  bundle: true,
  minify: true,
  legalComments: "none",
  charset: "utf8",
  target: ["chrome95", "firefox100", "safari15.2"],
  alias: { "snug-module": join(module_folder, "snug.mjs") },
  loader: { ".obj": "text" },
  absWorkingDir: here,
  logLevel: "warning",
};

async function bundled(entry, options) {
  const made = await build({ ...common, ...options, entryPoints: [join(here, entry)], write: false });
  return made.outputFiles[0].text;
}

async function makePackage() {
  const folder = join(output, "package");
  await rm(folder, { recursive: true, force: true });
  await mkdir(folder, { recursive: true });
  await writeFile(join(folder, "snug.js"), await bundled("package/snug.js", { format: "esm", target: "es2022", external: ["node:fs/promises"] }));
  // One glue serves both modules.
  const glue = async (name) => (await readFile(join(module_folder, `${name}.mjs`), "utf8")).replaceAll(`${name}.wasm`, "");
  if ((await glue("snug")) !== (await glue("snug.simd"))) throw new Error("snug.mjs and snug.simd.mjs differ: the module for vectors needs its own glue");
  for (const name of ["snug.wasm", "snug.simd.wasm"]) await cp(join(module_folder, name), join(folder, name));
  for (const name of ["snug.d.ts", "worker.js", "worker.d.ts", "thread.js", "package.json", "README.md"]) await cp(join(here, "package", name), join(folder, name));
  await cp(join(here, "../LICENSE"), join(folder, "LICENSE"));
}

// The page has the module for vectors, zipped: a browser that unzips knows these.
const newer = { target: ["chrome95", "firefox113", "safari16.4"] };
// Where a script stands inside a page, nothing may look like its end.
const inside = (text) => text.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");

async function makePage() {
  const parts = {
    style: await readFile(join(here, "page/style.css"), "utf8"),
    wasm: gzipSync(await readFile(join(module_folder, "snug.simd.wasm")), { level: 9 }).toString("base64"),
    engine: inside(await bundled("page/engine.js", { ...newer, format: "iife", define: { "import.meta.url": '"file:///"' }, external: ["node:fs/promises"] })),
    main: inside(await bundled("page/main.js", { ...newer, format: "esm" })),
  };
  const page = await readFile(join(here, "page/index.html"), "utf8");
  await writeFile(join(output, "snug.html"), page.replace(/\/\*(style|wasm|engine|main)\*\//g, (_, name) => parts[name]));
}

await mkdir(output, { recursive: true });
await makePackage();
await makePage();
