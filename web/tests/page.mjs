// The page in Chromium: node --test web/tests/page.mjs, with SNUG (the native command) and SNUG_PAGE. Its numbers are held
// against the command that the page itself names. Pictures of it are left beside the page, in screenshots/.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, extname, join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { linesOf } from "../../tests/doors/ask.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const command = resolve(process.env.SNUG ?? join(root, "build/release/bin/snug"));
const page_file = resolve(process.env.SNUG_PAGE ?? join(root, "build/web/snug.html"));
const package_folder = resolve(process.env.SNUG_PACKAGE ?? join(root, "build/web/package"));
const models = join(root, "examples/models");
const corpus = join(root, "tests/corpus");
const pictures = join(dirname(page_file), "screenshots");
const browser_file = ["chromium", "chromium-browser", "google-chrome"].map((name) => join("/usr/bin", name)).find(existsSync);
const skip = browser_file ? false : "there is no Chromium: scripts/install_packages page";

let browser, scratch;
before(async () => {
  if (skip) return;
  mkdirSync(pictures, { recursive: true });
  scratch = mkdtempSync(join(tmpdir(), "snug-"));
  browser = await chromium.launch({ executablePath: browser_file, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
});
after(async () => {
  await browser?.close();
  if (scratch) rmSync(scratch, { recursive: true });
});

// Opens the page; close() tells what it had to complain of, and whether it asked for anything but itself.
// `found`: as somebody finds it who opens it; else without its story and with everything unfolded.
async function open({ file = page_file, width = 1280, height = 800, found = false, ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, ...more });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text()) && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(error.stack));
  page.on("request", (request) => !/^(file|blob|data):/.test(request.url()) && faults.push(`asked for ${request.url()}`));
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => document.body.dataset.ready, null, { timeout: 60_000 });
  await idle(page);
  if (!found) {
    await page.evaluate(() => {
      document.getElementById("story-skip").click();
      for (const each of document.querySelectorAll("#digits, #more")) each.open = true;
    });
  }
  return {
    page,
    picture: (name) => page.screenshot({ path: join(pictures, `${name}.png`) }),
    close: async () => {
      await context.close();
      assert.deepEqual(faults, []);
    },
  };
}
const idle = async (page) => {
  await page.evaluate(() => new Promise((done) => setTimeout(done, 30)));
  await page.waitForFunction(() => !window.snugPage.state().busy, null, { timeout: 60_000 });
};
const verdict = (page) => page.textContent("#verdict");

// What the page shows is what the command answers that it names, double by double and digit by digit.
// `folder`: of the files, beside the models.
async function holdAgainstCommand(page, folder = models) {
  await idle(page);
  const { answer } = await page.evaluate(() => window.snugPage.state());
  const lines = await page.evaluate(() => window.snugPage.commands());
  const [collide, distance] = lines.map((line) => {
    assert.match(line, /^snug (collide|distance) /);
    const run = spawnSync("bash", ["-c", `"$SNUG" ${line.slice(5)} --json --quiet`], { cwd: folder, encoding: "utf8", env: { ...process.env, SNUG: command } });
    assert.ok([0, 5].includes(run.status), run.stderr);
    return JSON.parse(run.stdout);
  });
  const open_ended = ([lower, upper]) => [lower, Number.isFinite(upper) ? upper : null];
  assert.equal(answer.question.tolerance, collide.tolerance);
  assert.equal(answer.question.tolerance, distance.absolute);
  assert.equal(answer.collision.verdict, collide.verdict);
  assert.deepStrictEqual(open_ended(answer.collision.distance), collide.distance);
  assert.deepStrictEqual(answer.distance.distance, distance.distance);
  assert.deepStrictEqual(answer.distance.witness, distance.witness);
  assert.deepStrictEqual(answer.collision.witness, collide.witness);
  assert.equal((await verdict(page)).toLowerCase().split(" ")[0], collide.verdict);
  const [lower, upper] = distance.distance;
  const contact = collide.verdict === "intersecting" || upper === 0;
  assert.equal(await page.textContent("#exact"), contact ? "contact is proved" : `exactly ${lower} to ${upper}`);
  if (!contact) {
    // Six digits, outwards.
    const [least, most] = (await page.textContent("#interval")).split(" to ");
    assert.ok(Number(least) <= lower && lower - Number(least) <= 1.01e-5 * Math.abs(lower), `${least} ${lower}`);
    assert.ok(Number(most) >= upper && Number(most) - upper <= 1.01e-5 * Math.abs(upper), `${most} ${upper}`);
    for (const text of [least, most]) assert.ok(text.replace(/e.*/, "").replace(/^0\.0*|\./g, "").length <= 6, text);
  }
}

test("gives a proof that snug-check accepts", { skip }, async () => {
  const { page, close } = await open();
  await idle(page);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#proof")]);
  assert.equal(download.suggestedFilename(), "snug-proof.txt");
  const says = execFileSync(join(dirname(command), "snug-check"), [await download.path()], { encoding: "utf8" });
  assert.match(says, /proved: surface 0 .* and surface 1 /);
  assert.equal(await page.textContent("#proof-text"), "");
  await close();
});

test("its module gives the digits of the command to questions of every kind", { skip }, async () => {
  const { page, close } = await open();
  const scripts = [join(package_folder, "snug.js"), join(root, "tests/doors/answers.mjs")].map((path) => readFileSync(path, "utf8"));
  await page.evaluate(async (texts) => {
    const [{ default: Snug }, { holdAll }] = await Promise.all(texts.map((text) => import(URL.createObjectURL(new Blob([text], { type: "text/javascript" })))));
    const zipped = new Blob([Uint8Array.from(atob(document.getElementById("snug-wasm").textContent), (c) => c.charCodeAt(0))]).stream();
    const snug = await Snug({ wasm: await new Response(zipped.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer() });
    window.hold = (lines, files) => holdAll(snug, lines, (path) => files[path]);
  }, scripts);
  const lines = linesOf(command, scratch), counts = {};
  for (let begin = 0; begin < lines.length; begin += 200) {
    const some = lines.slice(begin, begin + 200), files = some.flatMap((line) => JSON.parse(line).files);
    const texts = Object.fromEntries(files.map((path) => [path, readFileSync(path, "utf8")]));
    const held = await page.evaluate(([each, texts]) => window.hold(each, texts), [some, texts]);
    for (const [kind, n] of Object.entries(held)) counts[kind] = (counts[kind] ?? 0) + n;
  }
  assert.ok(Object.keys(counts).length === 21 && Object.values(counts).every((n) => n >= 10), JSON.stringify(counts));
  await close();
});

test("six digits are rounded outwards", async () => {
  const { six } = await import("../page/digits.js");
  assert.deepEqual([0.205171585, 0.2035401, 0.2, 0.5, 12, 0, 1e-9, 123456789].map((x) => [six(x, false), six(x, true)]), [
    ["0.205171", "0.205172"], ["0.203540", "0.203541"], ["0.199999", "0.200001"], ["0.5", "0.5"], ["12", "12"], ["0", "0"], ["9.9999e-10", "1.00001e-9"], ["123456000", "123457000"],
  ]);
  let seed = 1;
  for (let i = 0; i < 20000; ++i) {
    seed = (seed * 48271) % 2147483647;
    const x = (seed / 2147483647) * 10 ** (Math.floor(i / 1000) - 10);
    assert.ok(Number(six(x, false)) <= x && Number(six(x, true)) >= x, `${x}`);
  }
});

const middle = (page, index) => page.evaluate((i) => {
  const { left, top } = document.getElementById("stage").getBoundingClientRect();
  const [x, y] = window.snugPage.seen(window.snugPage.middle(i));
  return [x + left, y + top];
}, index);

test("opens with a first answer, and asks for nothing", { skip }, async () => {
  const { page, picture, close } = await open({ found: true });
  console.log(`first answer and all shown after ${await page.evaluate(() => document.body.dataset.ready)} ms`);
  assert.ok((await page.evaluate(() => Number(document.body.dataset.ready))) < 5000);
  assert.equal(await verdict(page), "Separated");
  await holdAgainstCommand(page);
  await picture("opened");
  await close();
});

test("a story of three steps, of few controls, which a drag carries on", { skip }, async () => {
  const { page, close } = await open({ found: true });
  const title = () => page.textContent("#story-title");
  assert.equal(await title(), "Cages lie");
  const controls = await page.evaluate(() => [...document.querySelectorAll("button, input, select, summary, textarea")]
    .filter((e) => e.checkVisibility() && !e.closest("#story") && !(e.closest("details") && !e.closest("details").open && e.tagName !== "SUMMARY")).map((e) => e.id || e.textContent));
  assert.ok(controls.length <= 8, controls.join());
  // The tip is inside A's cage, and the surfaces are apart.
  assert.equal(await verdict(page), "Separated");
  await page.click("#story-next");
  assert.equal(await title(), "Now drag the pin");
  const [x, y] = await middle(page, 1);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 60; ++i) await page.mouse.move(x + 2 * i, y - 2 * i);
  await page.mouse.up();
  await idle(page);
  assert.equal(await verdict(page), "Intersecting");
  assert.equal(await title(), "Take the proof along");
  await page.click("#story-next");
  assert.equal(await page.isVisible("#story"), false);
  await close();
});

test("arrows move a part along an axis, rings turn it about one", { skip }, async () => {
  const { page, picture, close } = await open();
  const pose = () => page.evaluate(() => window.snugPage.state().poses[1]);
  const before = await pose();
  const pull = async (dx, dy, ex, ey) => {
    const [x, y] = await middle(page, 1);
    await page.mouse.move(x + dx, y + dy);
    await page.mouse.down();
    for (let i = 1; i <= 10; ++i) await page.mouse.move(x + dx + (ex * i) / 10, y + dy + (ey * i) / 10);
    await page.mouse.up();
    await idle(page);
  };
  await pull(70, 5, 80, 0);
  const along = await pose();
  assert.ok(along[3] > before[3] + 0.1, `${along}`);
  for (const k of [0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11]) assert.ok(Math.abs(along[k] - before[k]) < 1e-12, `${k}: ${along}`);
  await holdAgainstCommand(page);
  await page.selectOption("#handles", "rotate");
  const centre = await page.evaluate(() => window.snugPage.middle(1));
  await picture("rings");
  // Rings about the axes; one of them is under one of these places.
  for (const [dx, dy] of [[60, 0], [45, 45], [0, 60], [-45, 45], [50, 20], [20, 50]]) {
    await pull(dx, dy, -dy / 2, dx / 2);
    if ((await pose())[0] !== along[0]) break;
  }
  const turned = await pose();
  assert.notEqual(turned[0], along[0]);
  const length = Math.hypot(turned[0], turned[1], turned[2]);
  assert.ok(Math.abs(length - 1) < 1e-12, "stays rigid");
  const still = await page.evaluate(() => window.snugPage.middle(1));
  assert.ok(centre.every((x, k) => Math.abs(x - still[k]) < 1e-6), `${centre} ${still}`);
  await holdAgainstCommand(page);
  await page.selectOption("#handles", "");
  await close();
});

test("axe finds nothing serious, and nothing is blank below", { skip }, async () => {
  const axe = readFileSync(join(root, "web/node_modules/axe-core/axe.min.js"), "utf8");
  for (const how of [{}, { colorScheme: "dark" }, { width: 390, height: 844 }, { width: 390, height: 844, colorScheme: "dark" }]) {
    for (const found of [true, false]) {
      const { page, picture, close } = await open({ ...how, found });
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
      assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`), []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight && document.documentElement.scrollWidth <= innerWidth));
      if (found) await picture(`found-${how.width ?? 1280}-${how.colorScheme ?? "light"}`);
      await close();
    }
  }
});

test("a page without the engine shows the parts and the answer", { skip }, async () => {
  const made = join(scratch, "still.html"), bin = join(scratch, "bin"), answer = join(scratch, "still.json");
  mkdirSync(bin);
  copyFileSync(command, join(bin, "snug"));
  const parts = ["bracket.obj", "pin.obj"].map((name) => join(models, name));
  execFileSync(command, ["distance", ...parts, "--rotate-b", "z 135", "--move-b", "0.05 0.05 0.5", "--quiet", "-o", answer]);
  execFileSync(join(bin, "snug"), ["view", ...parts, "--answer", answer, "--quiet", "-o", made]);
  for (const how of [{}, { width: 390, height: 844, colorScheme: "dark" }]) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...how });
    const page = await context.newPage();
    const faults = [];
    page.on("pageerror", (error) => faults.push(error.stack));
    await page.goto(pathToFileURL(made).href);
    await page.waitForFunction(() => document.body.dataset.ready);
    assert.match(await page.textContent("#sentence"), /^Proved: the limit surfaces are between 0\.2\d+ and 0\.2\d+ apart\.$/);
    assert.equal(await page.locator("#parts li").count(), 2);
    await page.screenshot({ path: join(pictures, `still-${how.width ?? 1280}.png`) });
    assert.deepEqual(faults, []);
    await context.close();
  }
});

test("a drag changes the verdict, with the command's numbers, within 5 ms a question", { skip }, async () => {
  const { page, picture, close } = await open();
  const pose = () => page.evaluate(() => window.snugPage.state().poses[1]);
  const before = await pose();
  let [x, y] = await middle(page, 1);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.evaluate(() => window.snugPage.times());
  const seen = new Set();
  const start = Date.now();
  for (let i = 0; i < 120; ++i) {
    await page.mouse.move((x += 1), (y -= 1));
    seen.add(await verdict(page));
    if (i % 40 === 20) await holdAgainstCommand(page);
  }
  const seconds = (Date.now() - start) / 1000;
  await idle(page);
  const times = (await page.evaluate(() => window.snugPage.times())).sort((a, b) => a - b);
  const median = times[times.length >> 1];
  console.log(`${times.length} answers in ${seconds.toFixed(1)} s with the checks between; median ${median.toFixed(2)} ms, 95 % below ${times[Math.floor(0.95 * times.length)].toFixed(2)} ms`);
  assert.ok(median < 5, `a question takes ${median} ms`);
  await page.mouse.up();
  assert.notDeepEqual(await pose(), before);
  assert.equal(await verdict(page), "Intersecting");
  assert.ok(seen.has("Separated") && seen.has("Intersecting"), [...seen].join());
  await holdAgainstCommand(page);
  await picture("intersecting");
  const { rate } = await page.evaluate(async () => {
    // Drags as fast as they are answered: what the geometry alone allows.
    const stage = document.getElementById("stage");
    const frame = () => new Promise((done) => setTimeout(done));
    window.snugPage.times();
    const began = performance.now();
    stage.focus();
    let count = 0;
    while (performance.now() - began < 2000) {
      stage.dispatchEvent(new KeyboardEvent("keydown", { key: count++ % 2 ? "ArrowLeft" : "ArrowRight", bubbles: true }));
      while (window.snugPage.state().busy) await frame();
    }
    return { rate: count / 2 };
  });
  console.log(`${rate} moves a second answered, pictures included`);
  await close();
});

test("keys move a part, turn it and put it back", { skip }, async () => {
  const { page, picture, close } = await open();
  const poses = () => page.evaluate(() => window.snugPage.state().poses);
  const before = await poses();
  await page.focus("#stage");
  for (let i = 0; i < 60 && (await verdict(page)) !== "Intersecting"; ++i) {
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowUp");
    await idle(page);
  }
  assert.equal(await verdict(page), "Intersecting");
  await holdAgainstCommand(page);
  await picture("keys");
  await page.keyboard.press("PageDown");
  await page.keyboard.press("Shift+ArrowLeft");
  await page.keyboard.press("]");
  await idle(page);
  const [a, b] = await poses();
  assert.deepEqual(a, before[0]);
  assert.notEqual(b[0], before[1][0]);
  await holdAgainstCommand(page);
  await page.keyboard.press("a");
  await page.keyboard.press("ArrowDown");
  await idle(page);
  assert.notDeepEqual((await poses())[0], before[0]);
  await holdAgainstCommand(page);
  await page.keyboard.press("Home");
  await idle(page);
  assert.deepEqual(await poses(), before);
  assert.equal(await verdict(page), "Separated");
  await page.keyboard.press("h");
  assert.ok(await page.isVisible("#keys"));
  await picture("help");
  await close();
});

async function drop(page, path, selector = "#stage", name = basename(path)) {
  const data = await page.evaluateHandle(([base64, name]) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const transfer = new DataTransfer();
    transfer.items.add(new File([bytes], name));
    return transfer;
  }, [readFileSync(path).toString("base64"), name]);
  await page.dispatchEvent(selector, "dragenter", { dataTransfer: data });
  await page.dispatchEvent(selector, "drop", { dataTransfer: data, clientX: 3, clientY: 3 });
  await page.evaluate(() => new Promise((done) => setTimeout(done, 100)));
  await idle(page);
}

test("bad files are refused in the command's words, and what was there stays", { skip }, async () => {
  const { page, picture, close } = await open();
  for (const name of ["coordinate_nan.obj", "count_huge.stl", "blank.off", "binary.off", "comment_backslash.obj", "coincident_vertices.obj"]) {
    const native = spawnSync(command, ["bound", name, "--quiet", "-o", join(scratch, "bound.json")], { cwd: corpus, encoding: "utf8" });
    await page.evaluate(() => (document.querySelector("#fault span").textContent = ""));
    await drop(page, join(corpus, name));
    const said = await page.evaluate(() => (document.getElementById("fault").hidden ? "" : document.querySelector("#fault span").textContent));
    assert.equal(said, native.status === 0 ? "" : native.stderr.trim().replace(/^snug: /, ""), name);
    if (native.status !== 0) assert.equal((await page.evaluate(() => window.snugPage.state().names))[0], "bracket.obj");
    if (name === "coordinate_nan.obj") await picture("refused");
  }
  await drop(page, join(models, "pawn.obj"), "#part-b");
  assert.deepEqual(await page.evaluate(() => window.snugPage.state().names), ["bracket.obj", "pawn.obj"]);
  assert.equal(await page.isVisible("#fault"), false);
  await holdAgainstCommand(page);
  await close();
});

// A box of twelve triangles as an ASCII STL, an OFF or an OBJ.
function boxOfTriangles(format) {
  const points = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [4 * (k & 1), k & 2, (k & 4) / 4]);
  const faces = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]];
  const row = (numbers) => numbers.join(" ");
  if (format === "off") return ["OFF", "8 12 0", ...points.map(row), ...faces.map((face) => `3 ${row(face)}`), ""].join("\n");
  if (format === "obj") return [...points.map((p) => `v ${row(p)}`), ...faces.map((face) => `f ${row(face.map((v) => v + 1))}`), ""].join("\n");
  const facet = (face) => ["facet normal 0 0 0", "outer loop", ...face.map((v) => `vertex ${row(points[v])}`), "endloop", "endfacet"];
  return ["solid box", ...faces.flatMap(facet), "endsolid box", ""].join("\n");
}

test("triangles mean triangles, and a line says where they are smoothed", { skip }, async () => {
  const { page, picture, close } = await open();
  const lines = () => page.locator("#part-a p.fine").allTextContents();
  copyFileSync(join(models, "pin.obj"), join(scratch, "pin.obj"));
  for (const [format, smoothed] of [["stl", false], ["off", true], ["obj", true]]) {
    const file = join(scratch, `box.${format}`);
    writeFileSync(file, boxOfTriangles(format));
    await drop(page, file, "#part-a");
    const [facts, ...notes] = await lines();
    assert.equal(facts, `8 vertices, 12 faces, ${smoothed ? "loop" : "flat"}`);
    assert.equal(notes.length, smoothed ? 1 : 0);
    if (smoothed) {
      assert.match(notes[0], /^box\.\w+: triangles taken as the control mesh of a Loop surface, up to [\d.]+ \(.* % of the size\) away from them; scheme flat takes the facets, scheme loop says that this is meant$/);
      if (format === "off") await picture("smoothed");
      for (const scheme of ["flat", "loop"]) {
        await page.selectOption("#scheme-a", scheme);
        await idle(page);
        assert.deepEqual(await lines(), [`8 vertices, 12 faces, ${scheme}`]);
      }
    } else {
      await page.check("#sharp");
      await idle(page);
      assert.deepEqual(await lines(), ["8 vertices, 12 faces, loop"]);
      await holdAgainstCommand(page, scratch);
      await page.uncheck("#sharp");
      await idle(page);
    }
    await holdAgainstCommand(page, scratch);
  }
  await close();
});

test("the commands are quoted for any name", { skip }, async () => {
  const { page, close } = await open();
  copyFileSync(join(models, "pin.obj"), join(scratch, "pin.obj"));
  for (const name of ["-box.obj", "--help.obj", "a !b!!.obj", "it's $HOME `x` \"y\" \\.obj", "~ #;&|*?[x](y)<z>.obj"]) {
    writeFileSync(join(scratch, name), boxOfTriangles("obj"));
    await drop(page, join(scratch, name), "#part-a");
    assert.equal((await page.evaluate(() => window.snugPage.state().names))[0], name);
    await holdAgainstCommand(page, scratch);
    // As it is typed, where `!` expands.
    const [line] = await page.evaluate(() => window.snugPage.commands());
    const typed = spawnSync("bash", ["--norc", "--noprofile", "-i"], {
      input: `set -o history -H; PS1=\necho before\n${line.replace(/^snug/, "printf '%s\\n'")}\n`, encoding: "utf8", cwd: scratch, env: { ...process.env, HISTFILE: "/dev/null" },
    });
    assert.equal(typed.stdout.split("\n")[2], name.replace(/^-/, "./-"), typed.stderr);
  }
  await close();
});

test("schemes, sharpness, tolerance, solids, layers", { skip }, async () => {
  const { page, picture, close } = await open();
  const shown = () => page.textContent("#shown");
  await page.selectOption("#scheme-a", "doo-sabin");
  await idle(page);
  await holdAgainstCommand(page);
  await page.selectOption("#scheme-a", "catmark");
  await page.check("#sharp");
  await idle(page);
  await holdAgainstCommand(page);
  assert.match((await page.evaluate(() => window.snugPage.commands()))[0], /--scheme-a catmark .*--sharp 30/);
  await page.selectOption("#scheme-b", "midedge");
  await idle(page);
  assert.match(await page.textContent("#fault span"), /midedge has no creases/);
  await page.uncheck("#sharp");
  await page.fill("#tolerance", "9");
  await idle(page);
  await holdAgainstCommand(page);
  await page.check("#solid");
  await idle(page);
  await holdAgainstCommand(page);
  await page.check("#show-enclosures");
  await page.fill("#level", "1");
  await idle(page);
  await page.waitForFunction(() => /112 enclosures.*448 enclosures/.test(document.getElementById("shown").textContent));
  await picture("enclosures");
  await page.uncheck("#show-enclosures");
  await page.check("#adaptive");
  await page.check("#show-mesh");
  await idle(page);
  assert.match(await shown(), /triangles within/);
  await picture("adaptive");
  await page.uncheck("#adaptive");
  await page.selectOption("#example", "1");
  await page.evaluate(() => new Promise((done) => setTimeout(done, 300)));
  await page.check("#show-hulls");
  await idle(page);
  await page.waitForFunction(() => /hulls proved.*hulls/.test(document.getElementById("shown").textContent), null, { timeout: 60_000 });
  assert.equal(await verdict(page), "Separated");
  await picture("hulls");
  await close();
});

test("fingers: one moves a part, two turn the view; the page fits a phone", { skip }, async () => {
  const { page, picture, close } = await open({ width: 390, height: 844, hasTouch: true, isMobile: true });
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const poses = () => page.evaluate(() => window.snugPage.state().poses);
  const before = await poses();
  const [x, y] = await middle(page, 1);
  await touch("touchStart", [x, y]);
  for (let i = 1; i <= 30; ++i) await touch("touchMove", [x + 1.5 * i, y - 1.5 * i]);
  await touch("touchEnd");
  await idle(page);
  const after_one = await poses();
  assert.notDeepEqual(after_one[1], before[1]);
  assert.deepEqual(after_one[0], before[0]);
  await holdAgainstCommand(page);
  const [u, v] = await middle(page, 0);
  const eye = () => page.evaluate(() => window.snugPage.seen([1, 0, 0]));
  const seen = await eye();
  await touch("touchStart", [u, v]);
  await touch("touchStart", [u, v], [u + 60, v]);
  for (let i = 1; i <= 20; ++i) await touch("touchMove", [u + 3 * i, v], [u + 60 + 3 * i, v]);
  await touch("touchEnd");
  await idle(page);
  assert.deepEqual(await poses(), after_one);
  assert.notDeepEqual(await eye(), seen);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await picture("phone");
  await close();
});

test("in the dark, and without colours", { skip }, async () => {
  const { page, picture, close } = await open({ colorScheme: "dark" });
  await page.addStyleTag({ content: "html { filter: grayscale(1); }" });
  await picture("dark-without-colours");
  // Each control has a name, and the verdict is in words beside its sign.
  const unnamed = await page.evaluate(() => [...document.querySelectorAll("input, select, button")].filter((e) => !(e.labels?.length || e.getAttribute("aria-label") || e.textContent.trim())).map((e) => e.outerHTML));
  assert.deepEqual(unnamed, []);
  assert.ok(await page.isVisible("#sign .separated"));
  await close();
});

test("`snug view` makes the page of one's own parts and answer", { skip }, async () => {
  const answer = join(scratch, "answer.json"), made = join(scratch, "view.html");
  const [bracket, pin] = ["bracket.obj", "pin.obj"].map((name) => join(models, name));
  execFileSync(command, ["collide", bracket, pin, "--rotate-b", "z -45", "--move-b", "1.5 1.5 0.5", "--tolerance", "0.5%", "--quiet", "-o", answer]);
  execFileSync(command, ["view", bracket, pin, "--answer", answer, "--template", page_file, "--quiet", "-o", made]);
  const { page, picture, close } = await open({ file: made });
  assert.match(await page.textContent("#file-answer"), /separated.*This page finds the same, digit by digit/);
  assert.equal(await page.textContent("#tolerance-text"), "0.5 %");
  await holdAgainstCommand(page);
  await picture("view");
  await close();
  execFileSync(command, ["view", join(models, "pawn.obj"), "--template", page_file, "--quiet", "-o", made]);
  const one = await open({ file: made });
  assert.equal(await verdict(one.page), "One part");
  await one.picture("one");
  await one.close();
});

test("a scene is shown with its placed parts, and any two of them are asked about", { skip }, async () => {
  const scene = join(scratch, "scene.json"), made = join(scratch, "scene.html");
  const mesh = (name) => join(models, `${name}.obj`);
  const parts = [];
  for (let i = 0; i < 10; ++i) parts.push({ mesh: mesh(i % 2 ? "pin" : "bracket"), place: { rotate: `z ${20 * i}`, move: [2 * i, 0, i % 3] } });
  parts.push({ name: "faceted star", mesh: mesh("star"), sharp: 20, place: { move: [3, 9, 0] } });
  parts.push({ name: "faceted pawn", mesh: mesh("pawn"), sharp: 20, place: { move: [9, 9, 0] } });
  writeFileSync(scene, JSON.stringify({ parts }));
  execFileSync(command, ["view", "--scene", scene, "--template", page_file, "--quiet", "-o", made]);
  const { page, picture, close } = await open({ file: made });
  await holdAgainstCommand(page);
  for (const [a, b] of [[2, 3], [4, 9], [0, 2], [10, 11]]) {
    await page.selectOption("#pair-a", String(a));
    await page.selectOption("#pair-b", String(b));
    await holdAgainstCommand(page);
  }
  assert.match((await page.evaluate(() => window.snugPage.commands()))[0], /star.obj .*pawn.obj .*--sharp 20/);
  assert.equal(await page.inputValue("#level"), "1");
  await page.check("#show-enclosures");
  await idle(page);
  assert.match(await page.textContent("#shown"), /^A: \d+ triangles, \d+ enclosures; B: [^;]*; 12 parts: \d+ triangles$/);
  await picture("scene");
  await page.selectOption("#pair-a", "0");
  await idle(page);
  assert.match((await page.evaluate(() => window.snugPage.commands()))[0], /options of their own/);
  // Another scheme for one of the parts that share a surface leaves the others as they are.
  await page.selectOption("#pair-b", "2");
  await page.selectOption("#scheme-b", "bilinear");
  await holdAgainstCommand(page);
  await page.selectOption("#pair-b", "4");
  await holdAgainstCommand(page);
  await close();
});


// A page of somebody else's: three and the package from npm, put together by esbuild, and nothing but arrays between them.
test("three draws a tessellation of arrays", { skip }, async () => {
  const { build } = await import("esbuild");
  const entry = `
    import Snug from ${JSON.stringify(join(package_folder, "snug.js"))};
    import * as three from "three";
    const snug = await Snug({ wasm: Uint8Array.from(atob(document.getElementById("wasm").textContent), (c) => c.charCodeAt(0)) });
    const points = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [k & 1, (k >> 1) & 1, k >> 2].map((x) => 2 * x - 1));
    const corners = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
    const surface = snug.fromArrays({ points, offsets: [0, 4, 8, 12, 16, 20, 24], corners }, { scheme: "catmark" });
    const { positions, normals, triangles } = surface.tessellate({ error: 0.01 });
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(Float32Array.from(positions), 3));
    geometry.setAttribute("normal", new three.BufferAttribute(Float32Array.from(normals), 3));
    geometry.setIndex(new three.BufferAttribute(triangles, 1));
    const scene = new three.Scene().add(new three.Mesh(geometry, new three.MeshNormalMaterial()));
    const camera = new three.PerspectiveCamera(40, 1, 0.1, 100);
    camera.position.set(0, 0, 4);
    const renderer = new three.WebGLRenderer({ preserveDrawingBuffer: true });
    renderer.setSize(300, 300);
    document.body.append(renderer.domElement);
    renderer.render(scene, camera);
    const gl = renderer.getContext(), pixels = new Uint8Array(4 * 300 * 300);
    gl.readPixels(0, 0, 300, 300, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const again = snug.fromGeometry(geometry);
    window.drawn = { triangles: triangles.length / 3, pixels: [...pixels], volume: [surface.measure().volume, again.measure().volume] };`;
  const made = await build({ stdin: { contents: entry, resolveDir: join(root, "web") }, bundle: true, write: false, format: "esm", target: "es2022", external: ["node:fs/promises"], logLevel: "error" });
  const file = join(scratch, "three.html"), inside = (text) => text.replace(/<\/(script)/gi, "<\\/$1");
  writeFileSync(file, `<body><script type="text/plain" id="wasm">${readFileSync(join(package_folder, "snug.wasm")).toString("base64")}</script><script type="module">${inside(made.outputFiles[0].text)}</script>`);
  const page = await browser.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.stack));
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.drawn, null, { timeout: 60_000 }).catch((error) => assert.deepEqual(faults, [], error.message));
  const { triangles, pixels, volume } = await page.evaluate(() => window.drawn);
  const lit = (x, y) => pixels.slice(4 * (300 * y + x), 4 * (300 * y + x) + 3);
  assert.ok(triangles > 100);
  // In the middle its normal points at us; in the corners there is nothing.
  const [red, green, blue] = lit(150, 150);
  assert.ok(Math.abs(red - 128) < 12 && Math.abs(green - 128) < 12 && blue > 240, `${lit(150, 150)}`);
  for (const at of [[2, 2], [297, 2], [2, 297], [297, 297]]) assert.deepEqual(lit(...at), [0, 0, 0]);
  assert.ok(volume[1][1] < volume[0][1] && volume[1][0] > 0.95 * volume[0][0], `${volume}`);
  await page.screenshot({ path: join(pictures, "three.png") });
  await page.close();
});

// The page in docs/browser.md, from a server as its reader has one.
test("the documentation's page of one's own draws and answers", { skip }, async () => {
  const [, text] = readFileSync(join(root, "docs/browser.md"), "utf8").match(/```html\n([^]*?)```/);
  const page = await browser.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.stack));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  const types = { ".js": "text/javascript", ".wasm": "application/wasm" };
  await page.route("http://one.own/**", (route) => {
    const { pathname } = new URL(route.request().url());
    if (pathname === "/") return route.fulfill({ contentType: "text/html", body: text });
    const file = pathname.startsWith("/node_modules/snug-surfaces/") ? join(package_folder, pathname.slice(28)) : join(root, "web", pathname);
    return route.fulfill({ contentType: types[extname(file)], body: readFileSync(file) });
  });
  await page.goto("http://one.own/");
  await page.waitForSelector("canvas", { timeout: 60_000 }).catch((error) => assert.deepEqual(faults, [], error.message));
  const [, lower, upper] = (await page.textContent("#answer")).match(/^separated, (0\.\d+) to (0\.\d+) apart$/);
  assert.ok(Number(lower) < Number(upper) && Number(upper) < 1.01 * Number(lower), `${lower} ${upper}`);
  assert.deepEqual(faults, []);
  await page.screenshot({ path: join(pictures, "own.png") });
  await page.close();
});
