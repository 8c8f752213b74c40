// Runs three.js's or PlayCanvas's clustered lighting with the camera and the lights of a captured frame, and writes the
// engine's light lists into the frame's folder, in place of those there: docs/frames.md#worked-example-threejs-and-playcanvas.
//     npm install three playcanvas
//     node tools/judge/judge_engine.mjs three|playcanvas FRAME [KEY=VALUE...]
//     lightgrid cull FRAME --judge -o judged
// The package is found in node_modules of the current folder or a folder above it. The engine runs in headless Chromium
// with WebGL on SwiftShader; $CHROMIUM names another browser. Keys: `settings` of judge_three.mjs and judge_playcanvas.mjs.
import {spawn} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const timeout_s = 300;
const types = {'.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.json': 'application/json'};
const [engine, frame, ...words] = process.argv.slice(2);
const given = words.map(word => word.split('='));

function fail(message) {
  console.error(`judge_engine: ${message}`);
  process.exit(2);
}

function modules_folder() {
  for (let folder = process.cwd();; folder = dirname(folder)) {
    if (existsSync(join(folder, 'node_modules', engine, 'package.json'))) return join(folder, 'node_modules');
    if (folder === dirname(folder)) fail(`${engine} is not installed here: npm install ${engine}`);
  }
}

const page = `<!DOCTYPE html><script type="importmap">{"imports": {
  "three": "/modules/three/build/three.webgpu.js", "three/webgpu": "/modules/three/build/three.webgpu.js",
  "three/tsl": "/modules/three/build/three.tsl.js", "three/addons/": "/modules/three/examples/jsm/",
  "playcanvas": "/modules/playcanvas/build/playcanvas.mjs"}}</script>
<script type="module">
  const post = (path, body) => fetch(path, {method: 'POST', body});
  window.addEventListener('unhandledrejection', e => post('/failed', String(e.reason?.message ?? e.reason)));
  window.addEventListener('error', e => post('/failed', String(e.message)));
  const {read_frame, with_given} = await import('/tools/frame.mjs');
  const {lists, settings} = await import('/tools/judge_${engine}.mjs');
  const made = await lists(await read_frame(), with_given(settings, ${JSON.stringify(given)}));
  const first_and_count = [], indices = [];
  for (const list of made.cells) {
    first_and_count.push(indices.length, list.length);
    for (const light of list.sort((a, b) => a - b)) indices.push(light);
  }
  await post('/grid.u32', new Uint32Array(first_and_count));
  await post('/indices.u32', new Uint32Array(indices));
  await post('/cell_of_pixel.u32', made.cell_of_pixel);
  await post('/grid.json', JSON.stringify({cells: [made.cells.length], cell_of_pixel: true}));
  await post('/done', made.summary);
</script>`;

if (!['three', 'playcanvas'].includes(engine) || !frame)
  fail('usage: judge_engine.mjs three|playcanvas FRAME [KEY=VALUE...]');
if (!existsSync(join(frame, 'view.json'))) fail(`${frame}: has no view.json`);
const roots = {modules: modules_folder(), frame: resolve(frame), tools: dirname(fileURLToPath(import.meta.url))};

const made = new Map();  // files for the frame's folder
const profile = mkdtempSync(join(tmpdir(), 'judge_engine'));
let browser;

function finish(status, text) {
  (status === 0 ? console.log : console.error)(text);
  if (browser?.pid) process.kill(-browser.pid, 'SIGKILL');
  setTimeout(() => {
    rmSync(profile, {recursive: true, force: true, maxRetries: 5});
    process.exit(status);
  }, 200);
}

// A browser outlives this process unless it is ended.
for (const [signal, status] of [['SIGINT', 130], ['SIGTERM', 143]])
  process.on(signal, () => finish(status, `judge_engine: ended by ${signal}`));

const server = createServer((request, answer) => {
  const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
  if (request.method === 'GET') {
    const [, root, ...rest] = path.split('/');
    const file = roots[root] && join(roots[root], ...rest);
    if (path !== '/' && !(file?.startsWith(roots[root]) && existsSync(file))) return answer.writeHead(404).end();
    answer.writeHead(200, {'content-type': path === '/' ? 'text/html' : types[extname(path)] ?? 'application/octet-stream'});
    return answer.end(path === '/' ? page : readFileSync(file));
  }
  const parts = [];
  request.on('data', part => parts.push(part));
  request.on('end', () => {
    const body = Buffer.concat(parts);
    answer.end();
    if (path === '/failed') return finish(2, `judge_engine: ${body}`);
    if (path !== '/done') return made.set(path.slice(1), body);
    for (const [name, contents] of made) writeFileSync(join(roots.frame, name), contents);
    finish(0, body.toString());
  });
});

server.listen(0, '127.0.0.1', () => {
  browser = spawn(process.env.CHROMIUM ?? 'chromium', [
    '--headless=new', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
    '--no-first-run', `--user-data-dir=${profile}`, `http://127.0.0.1:${server.address().port}/`],
    {detached: true, stdio: 'ignore'});
  browser.on('error', e => finish(2, `judge_engine: ${e.message}`));
});
setTimeout(() => finish(2, `judge_engine: no lists after ${timeout_s} s`), 1000 * timeout_s);
