// Runs three.js's or PlayCanvas's clustered lighting with the camera and the lights of a captured frame, and writes the
// engine's light lists into the frame's folder, in place of those there: docs/frames.md#worked-example-threejs-and-playcanvas.
//     npm install three playcanvas
//     node tools/engines/judge_engine.mjs three|playcanvas FRAME [KEY=VALUE...]
//     lightgrid cull FRAME --judge -o judged
// Keys: `settings` of judge_three.mjs and judge_playcanvas.mjs.
import {existsSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fail, finish, open_page} from './browser.mjs';

const timeout_s = 300;
const [engine, frame, ...words] = process.argv.slice(2);

if (!['three', 'playcanvas'].includes(engine) || !frame)
  fail('usage: judge_engine.mjs three|playcanvas FRAME [KEY=VALUE...]');
if (!existsSync(join(frame, 'view.json'))) fail(`${frame}: has no view.json`);

const made = new Map();  // files for the frame's folder
open_page([engine], `
  const {read_frame, with_given} = await import('/tools/frame.mjs');
  const {lists, settings} = await import('/tools/judge_${engine}.mjs');
  const made = await lists(await read_frame(), with_given(settings, ${JSON.stringify(words.map(word => word.split('=')))}));
  const first_and_count = [], indices = [];
  for (const list of made.cells) {
    first_and_count.push(indices.length, list.length);
    for (const light of list.sort((a, b) => a - b)) indices.push(light);
  }
  await post('/grid.u32', new Uint32Array(first_and_count));
  await post('/indices.u32', new Uint32Array(indices));
  await post('/cell_of_pixel.u32', made.cell_of_pixel);
  await post('/grid.json', JSON.stringify({cells: [made.cells.length], cell_of_pixel: true}));
  await post('/done', made.summary);`, {frame: resolve(frame)}, (path, body) => {
  if (path !== '/done') return made.set(path.slice(1), body);
  for (const [name, contents] of made) writeFileSync(join(frame, name), contents);
  finish(0, body.toString());
});
setTimeout(() => finish(2, `no lists after ${timeout_s} s`), 1000 * timeout_s);
