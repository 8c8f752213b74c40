// One frame of an engine in the page: the time until its picture, of floats, is in the page's memory.
let pixels = new Float32Array(0);

function read_floats(gl, texture, width, height) {
  if (pixels.length !== 4 * width * height) pixels = new Float32Array(4 * width * height);
  const before = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
  const reader = gl.createFramebuffer();
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, reader);
  gl.framebufferTexture2D(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, before);
  gl.deleteFramebuffer(reader);
  return pixels;
}

// `loaded`: {gl, place(request), draw(), texture()}.
export async function timed_frame(loaded, request) {
  loaded.place(request);
  const begin = performance.now();
  await loaded.draw();
  read_floats(loaded.gl, loaded.texture(), ...request.size);
  return {pixels, frame_ms: performance.now() - begin};
}

// Makes the changes {name: [chunk of shader, text, its replacement]} that `names` lists, "all" or "a+b".
export function apply_changes(changes, names, read, write) {
  const chosen = names === 'all' ? Object.keys(changes) : names.split('+').filter(Boolean);
  for (const name of chosen) {
    if (!changes[name]) throw new Error(`gltf=${name}: no change; changes are ${Object.keys(changes).join(', ')}`);
    for (let i = 0; i < changes[name].length; i += 3) {
      const [chunk, from, to] = changes[name].slice(i, i + 3), text = read(chunk);
      if (!text.includes(from)) throw new Error(`gltf=${name}: ${chunk} has no ${from}`);
      write(chunk, text.replaceAll(from, to));
    }
  }
}
