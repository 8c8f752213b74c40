// A page in headless Chromium, with WebGL on SwiftShader, that runs an engine of the npm packages in node_modules of the
// current folder or a folder above it. $CHROMIUM names another browser.
import {spawn} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const types = {'.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.json': 'application/json'};
const tool = process.argv[1].replace(/.*[/]|[.]mjs$/g, '');
const profile = mkdtempSync(join(tmpdir(), tool));
let browser, ended = false;

// Ends the tool and its browser.
export function finish(status, text) {
  if (ended) return;
  ended = true;
  if (text) (status === 0 ? console.log : console.error)(status === 0 ? text : `${tool}: ${text}`);
  browser?.kill('SIGKILL');
  setTimeout(() => {
    rmSync(profile, {recursive: true, force: true, maxRetries: 5});
    process.exit(status);
  }, 200);
}

export function fail(message) {
  console.error(`${tool}: ${message}`);
  rmSync(profile, {recursive: true, force: true});
  process.exit(2);
}

function modules_folder(packages) {
  for (let folder = process.cwd();; folder = dirname(folder)) {
    if (packages.every(name => existsSync(join(folder, 'node_modules', name, 'package.json')))) return join(folder, 'node_modules');
    if (folder === dirname(folder)) fail(`${packages.join(', ')}: not installed here: npm install ${packages.join(' ')}`);
  }
}

function page(script) {
  return `<!DOCTYPE html><meta charset="utf-8"><script type="importmap">{"imports": {
  "three": "/modules/three/build/three.webgpu.js", "three/webgpu": "/modules/three/build/three.webgpu.js",
  "three/tsl": "/modules/three/build/three.tsl.js", "three/addons/": "/modules/three/examples/jsm/",
  "playcanvas": "/modules/playcanvas/build/playcanvas.mjs"}}</script>
<script type="module">
  const post = (path, body) => fetch(path, {method: 'POST', body});
  window.addEventListener('unhandledrejection', e => post('/failed', String(e.reason?.message ?? e.reason)));
  window.addEventListener('error', e => post('/failed', String(e.message)));
  ${script}
</script>`;
}

// Opens the page that runs `script`, a module with post(path, body). It reads /modules, /tools (this folder) and the
// folders of `roots`, and what `on_get(path, answer)` sends; `on_post(path, body)` gets what it posts, except /failed.
// The process of the browser leads a group.
export function open_page(packages, script, roots, on_post, on_get = () => false) {
  const folders = {modules: modules_folder(packages), tools: dirname(fileURLToPath(import.meta.url)), ...roots};
  const server = createServer((request, answer) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (request.method === 'GET') {
      if (on_get(path, answer)) return;
      const [, root, ...rest] = path.split('/');
      const file = folders[root] && join(folders[root], ...rest);
      if (path !== '/' && !(file?.startsWith(folders[root]) && existsSync(file))) return answer.writeHead(404).end();
      // Isolated pages have a clock of 5 microseconds.
      answer.writeHead(200, {'content-type': path === '/' ? 'text/html' : types[extname(path)] ?? 'application/octet-stream',
                             'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp'});
      return answer.end(path === '/' ? page(script) : readFileSync(file));
    }
    const parts = [];
    request.on('data', part => parts.push(part));
    request.on('end', () => {
      const body = Buffer.concat(parts);
      answer.end();
      path === '/failed' ? finish(2, body) : on_post(path, body);
    });
  });
  server.listen(0, '127.0.0.1', () => {
    // Chromium ends when the pipe is closed, whatever ends this process.
    browser = spawn(process.env.CHROMIUM ?? 'chromium', [
      '--headless=new', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
      '--remote-debugging-pipe', '--no-first-run', `--user-data-dir=${profile}`, `http://127.0.0.1:${server.address().port}/`],
      {detached: true, stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    browser.on('error', e => finish(2, e.message));
    browser.on('exit', () => finish(2, 'the browser ended'));
  });
  for (const [signal, status] of [['SIGINT', 130], ['SIGTERM', 143]])
    process.on(signal, () => finish(status, `ended by ${signal}`));
  return {group: () => browser?.pid};
}
