// An EXR file with 32-bit channels, without compression.
export function exr_picture(rgba, width, height) {  // floats, bottom row first
  const int = (...values) => Buffer.from(Int32Array.from(values).buffer);
  const float = (...values) => Buffer.from(Float32Array.from(values).buffer);
  const attribute = (name, type, value) => Buffer.concat([Buffer.from(`${name}\0${type}\0`), int(value.length), value]);
  const channel = name => Buffer.concat([Buffer.from(`${name}\0`), int(2, 0, 1, 1)]);
  const box = int(0, 0, width - 1, height - 1);
  const header = Buffer.concat([
    int(20000630, 2), attribute('channels', 'chlist', Buffer.concat([...'BGR'].map(channel).concat(Buffer.alloc(1)))),
    attribute('compression', 'compression', Buffer.alloc(1)), attribute('dataWindow', 'box2i', box),
    attribute('displayWindow', 'box2i', box), attribute('lineOrder', 'lineOrder', Buffer.alloc(1)),
    attribute('pixelAspectRatio', 'float', float(1)), attribute('screenWindowCenter', 'v2f', float(0, 0)),
    attribute('screenWindowWidth', 'float', float(1)), Buffer.alloc(1)]);
  const row_bytes = 12 * width, first = header.length + 8 * height;
  const offsets = BigUint64Array.from({length: height}, (_, y) => BigInt(first + y * (8 + row_bytes)));
  const rows = [];
  for (let y = 0; y < height; ++y) {
    const at = (height - 1 - y) * width;
    const planes = Float32Array.from({length: 3 * width}, (_, i) =>
      rgba.readFloatLE(4 * (4 * (at + i % width) + 2 - Math.floor(i / width))));
    rows.push(int(y, row_bytes), Buffer.from(planes.buffer));
  }
  return Buffer.concat([header, Buffer.from(offsets.buffer), ...rows]);
}
