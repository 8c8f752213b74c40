// An engine on the plane: docs/engines_on_the_plane.md. Draws the frames that `lightgrid frontier --external` requests
// with three.js, PlayCanvas or Babylon.js in headless Chromium.
//     npm install three playcanvas babylonjs babylonjs-loaders
//     {"name": "three", "command": ["node", "tools/engines/plane_engine.mjs", "three", "KEY=VALUE"]}
// Keys: `settings` of plane_three.mjs, plane_playcanvas.mjs and plane_babylon.mjs.
import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {createInterface} from 'node:readline';
import {exr_picture} from './exr.mjs';
import {fail, finish, open_page} from './browser.mjs';

const packages = {three: ['three'], playcanvas: ['playcanvas'], babylon: ['babylonjs', 'babylonjs-loaders']};
const [engine, ...words] = process.argv.slice(2);
if (!packages[engine]) fail(`usage: plane_engine.mjs ${Object.keys(packages).join('|')} [KEY=VALUE...]`);

const script = `
  const {with_given} = await import('/tools/frame.mjs');
  const {load, settings} = await import('/tools/plane_${engine}.mjs');
  const {timed_frame} = await import('/tools/plane_page.mjs');
  const given = with_given(settings, ${JSON.stringify(words.map(word => word.split('=')))});
  let loaded, key;
  for (;;) {
    const request = await (await fetch('/request')).json();
    const needed = request.scene + request.size;
    try {
      if (key !== needed) loaded = await load(request, given);
      key = needed;
      await timed_frame(loaded, request);
      await post('/begin', '');
      const {pixels, frame_ms} = await timed_frame(loaded, request);
      await post('/end', '');
      if (request.picture) await post('/picture', pixels);
      await post('/answer', JSON.stringify({frame_ms}));
    } catch (e) {
      await post('/answer', JSON.stringify({error: String(e.stack ?? e)}));
    }
  }`;

// Milliseconds of processor time of all threads of the browser's processes.
function cpu_ms(group) {
  let ns = 0;
  for (const pid of readdirSync('/proc').filter(name => /^\d+$/.test(name))) {
    try {
      if (Number(readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/.*[)] /s, '').split(' ')[2]) !== group) continue;
      for (const task of readdirSync(`/proc/${pid}/task`))
        ns += Number(readFileSync(`/proc/${pid}/task/${task}/schedstat`, 'utf8').split(' ')[0]);
    } catch {}  // it has ended
  }
  return ns / 1e6;
}

const requests = [];
let waiting, current, begin_ms, used_ms;

function send_next() {
  if (!waiting || !requests.length) return;
  current = JSON.parse(requests.shift());
  waiting.end(JSON.stringify(current));
  waiting = undefined;
}

const page = open_page(packages[engine], script, {}, (path, body) => {
  if (path === '/begin') begin_ms = cpu_ms(page.group());
  if (path === '/end') used_ms = cpu_ms(page.group()) - begin_ms;
  if (path === '/picture') writeFileSync(current.picture, exr_picture(body, ...current.size));
  if (path !== '/answer') return;
  const answer = JSON.parse(body);
  console.log(JSON.stringify(answer.error ? answer : {...answer, cpu_ms: used_ms}));
}, (path, answer) => {
  if (path === '/scene.glb') answer.end(readFileSync(current.scene));
  else if (path === '/request') waiting = answer, send_next();
  else return false;
  return true;
});
createInterface({input: process.stdin}).on('line', line => requests.push(line) && send_next()).on('close', () => finish(0));
