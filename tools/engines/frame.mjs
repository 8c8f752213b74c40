// A captured frame (docs/frames.md) for the page that runs an engine.

// The engine's own settings with those given, which have the type of the former.
export function with_given(settings, given) {
  const result = {...settings};
  for (const [key, value] of given) {
    if (!(key in settings)) throw new Error(`${key}: no setting; settings are ${Object.keys(settings).join(', ')}`);
    result[key] = typeof settings[key] === 'number' ? Number(value) : value;
  }
  return result;
}

export async function read_frame() {
  const get = async name => {
    const answer = await fetch(`/frame/${name}`);
    if (!answer.ok) throw new Error(`the frame has no ${name}`);
    return answer;
  };
  const view = await (await get('view.json')).json();
  const all_lights = (await (await get('lights.json')).json()).lights;
  const depth = new Float32Array(await (await get('depth.f32')).arrayBuffer());
  const p = view.clip_from_view, w = -p[14];
  if (!(w > 0) || p[2] !== 0 || p[3] !== 0 || p[6] !== 0 || p[7] !== 0)
    throw new Error('view.json: clip_from_view: only centred perspective views are possible here');
  const at_near = p[11] / w / view.near - p[10] / w;
  if (!(Math.abs(at_near) < 1e-3 || Math.abs(at_near - 1) < 1e-3))
    throw new Error(`view.json: the near plane has depth ${at_near}; only depth from 0 to 1 is possible here`);
  const m = view.view_from_world;
  const eye = view.eye ?? [0, 1, 2].map(i => -(m[i] * m[3] + m[4 + i] * m[7] + m[8 + i] * m[11]));
  const lights = all_lights.filter(l => l.type !== 'directional')
    .map(l => ({type: 'point', inner_cone: 0, outer_cone: Math.PI / 4, ...l, radius: l.radius ?? l.range}));
  for (const l of lights)
    if (l.type === 'virtual' || l.outer_cone > Math.PI / 2)
      throw new Error(`lights.json: light "${l.name}": the engines have no ${l.type === 'virtual' ? 'virtual lights' : 'cones above 90 degrees'}`);
  return {view, lights, depth, eye, width: view.size[0], height: view.size[1], fov_y_rad: 2 * Math.atan(w / p[5])};
}

// Calls cell(x, row from the top, metres along the view axis, world position) for each pixel with a surface.
export function cell_of_pixel({view, depth, eye, width, height}, cell) {
  const p = view.clip_from_view.map(v => v / -view.clip_from_view[14]), m = view.view_from_world;
  const background = p[10] > -0.5 ? 0 : 1;  // reversed or standard depth
  const cells = new Uint32Array(width * height).fill(0xffffffff);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const d = depth[y * width + x];
      if (!(d >= 0 && d <= 1) || d === background) continue;
      const along = p[11] / (d + p[10]);
      const at = [along * ((2 * x + 1) / width - 1) / p[0], along * ((2 * y + 1) / height - 1) / p[5], -along];
      const world = [0, 1, 2].map(i => m[i] * at[0] + m[4 + i] * at[1] + m[8 + i] * at[2] + eye[i]);
      cells[y * width + x] = cell(x, height - 1 - y, along, world);
    }
  return cells;
}
