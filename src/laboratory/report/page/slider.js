// The before/after slider: any two pictures, cut at the position of the range input, enlarged together, and read at a pixel.

const MOST_ZOOM = 64;
let sliderChoices = [];
let zoomed = { scale: 1, x: 0, y: 0 };  // x, y: the shown part's upper left corner, as shares of the picture
const sliderPixels = {};                // of each side's picture, once read

const chosenOf = (side) => sliderChoices[byId(`${side}-picture`).value];
const within = (low, value, high) => Math.min(Math.max(value, low), high);

function showSliderSide(side) {
  const image = byId(`${side}-image`), choice = chosenOf(side);
  image.src = choice.url;
  image.alt = choice.label;
  delete sliderPixels[side];
  const notes = ["left", "right"].map((s) => chosenOf(s)?.note).filter(Boolean);
  byId("slider-legend").textContent = [...new Set(notes)].join(" ");
}

// groups: [{ label, choices: [{ label, url, note, value }] }]; left and right: the labels shown first.
function showSlider(groups, left, right) {
  sliderChoices = groups.flatMap((group) => group.choices);
  byId("slider").closest("section").hidden = sliderChoices.length === 0;
  if (sliderChoices.length === 0) return;
  for (const [side, first] of [["left", left], ["right", right]]) {
    const select = byId(`${side}-picture`);
    select.replaceChildren(...groups.map((group) => make("optgroup", { label: group.label },
      ...group.choices.map((c) => make("option", { value: sliderChoices.indexOf(c) }, c.label)))));
    select.value = Math.max(0, sliderChoices.findIndex((choice) => choice.label === first));
    showSliderSide(side);
  }
}

// Enlarges about a place, given as shares of the part shown.
function zoomTo(scale, atX = 0.5, atY = 0.5) {
  const next = within(1, scale, MOST_ZOOM), most = 1 - 1 / next;
  zoomed = { scale: next, x: within(0, zoomed.x + atX / zoomed.scale - atX / next, most), y: within(0, zoomed.y + atY / zoomed.scale - atY / next, most) };
  for (const side of ["left", "right"]) {
    byId(`${side}-image`).style.transform = `scale(${next}) translate(${-100 * zoomed.x}%, ${-100 * zoomed.y}%)`;
    byId(`${side}-image`).style.imageRendering = next > 1 ? "pixelated" : "";
  }
  byId("zoom-scale").textContent = `${shortNumber(next).replace(/\.0+$/, "")}\u00d7`;
}

// The bytes of a side's picture.
function pixelsOf(side) {
  const image = byId(`${side}-image`);
  if (!sliderPixels[side] && image.complete && image.naturalWidth > 0) {
    const canvas = make("canvas", { width: image.naturalWidth, height: image.naturalHeight });
    canvas.getContext("2d").drawImage(image, 0, 0);
    sliderPixels[side] = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  }
  return sliderPixels[side];
}

// atX, atY: shares of the part shown. Pixels are counted from the upper left, as `lightgrid inspect --pixel` does.
function readPixel(atX, atY) {
  const words = ["left", "right"].map((side) => {
    const pixels = pixelsOf(side);
    if (!pixels) return null;
    const x = within(0, Math.floor((zoomed.x + atX / zoomed.scale) * pixels.width), pixels.width - 1);
    const y = within(0, Math.floor((zoomed.y + atY / zoomed.scale) * pixels.height), pixels.height - 1);
    const colour = [...pixels.data.slice(4 * (y * pixels.width + x), 4 * (y * pixels.width + x) + 3)];
    const { label, value, reduced } = chosenOf(side);
    return { at: `${x * reduced},${y * reduced}`, text: `${label}: ${value ? value(colour) : colour.join(" ")}` };
  });
  byId("pixel").textContent = words.includes(null) ? "" : `Pixel ${words[0].at} \u00b7 ${words.map((word) => word.text).join(" \u00b7 ")}`;
}

const ramps = {};  // bytes of the legends' pictures, lowest first, once read

function loadRamp(number) {
  const image = new Image();
  image.addEventListener("load", () => {
    const canvas = make("canvas", { width: image.naturalWidth, height: 1 });
    canvas.getContext("2d").drawImage(image, 0, 0);
    ramps[number] = canvas.getContext("2d").getImageData(0, 0, canvas.width, 1).data;
  });
  image.src = pictureUrl(number);
}

// Where a color is on a legend, 0 to 1; null before it is read.
function shareOnRamp(number, color) {
  const ramp = ramps[number];
  if (!ramp) return null;
  const steps = ramp.length / 4, distance = (i) => color.reduce((sum, c, k) => sum + (c - ramp[4 * i + k]) ** 2, 0);
  let best = 0;
  for (let i = 1; i < steps; ++i) if (distance(i) < distance(best)) best = i;
  return best / (steps - 1);
}

const sliderState = () => ({ left: chosenOf("left")?.label, right: chosenOf("right")?.label, cut: byId("cut").value,
  zoom: [zoomed.scale, zoomed.x, zoomed.y].map((value) => Number(value.toFixed(4))).join(",") });

function setSliderState({ left, right, cut, zoom }) {
  for (const [side, label] of [["left", left], ["right", right]]) {
    const found = sliderChoices.findIndex((choice) => choice.label === label);
    if (found < 0) continue;
    byId(`${side}-picture`).value = found;
    showSliderSide(side);
  }
  if (cut) byId("cut").value = cut;
  byId("cut").dispatchEvent(new Event("input"));
  const [scale, x, y] = (zoom ?? "").split(",").map(Number);
  if (!(scale >= 1)) return;
  zoomed = { scale, x: x || 0, y: y || 0 };
  zoomTo(scale);
}

// changed(): called after each change by hand.
function startSlider(changed) {
  const slider = byId("slider"), cut = byId("cut");
  for (const side of ["left", "right"])
    byId(`${side}-picture`).addEventListener("change", () => { showSliderSide(side); changed(); });
  const moveCut = () => slider.style.setProperty("--cut", `${cut.value}%`);
  cut.addEventListener("input", moveCut);
  cut.addEventListener("change", changed);
  moveCut();
  const zoom = (factor, x, y) => { zoomTo(zoomed.scale * factor, x, y); changed(); };
  byId("zoom-in").addEventListener("click", () => zoom(2));
  byId("zoom-out").addEventListener("click", () => zoom(0.5));
  byId("zoom-all").addEventListener("click", () => zoom(0));
  zoomTo(1);

  // A drag moves the divider or, enlarged and begun away from it, the pictures.
  const shareAt = (event) => {
    const box = slider.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };
  let drag = null;
  slider.addEventListener("pointerdown", (event) => {
    const [x, y] = shareAt(event);
    drag = { x, y, divider: zoomed.scale === 1 || Math.abs(x - cut.value / 100) * slider.clientWidth < 24 };
    slider.setPointerCapture(event.pointerId);
    cut.focus({ preventScroll: true });
  });
  slider.addEventListener("pointermove", (event) => {
    const [x, y] = shareAt(event);
    readPixel(x, y);
    if (drag?.divider) {
      cut.value = 100 * x;
      moveCut();
    } else if (drag) {
      zoomed.x += (drag.x - x) / zoomed.scale, zoomed.y += (drag.y - y) / zoomed.scale;
      drag.x = x, drag.y = y;
      zoomTo(zoomed.scale);
    }
  });
  for (const end of ["pointerup", "pointercancel"]) slider.addEventListener(end, () => { if (drag) changed(); drag = null; });
  slider.addEventListener("dblclick", (event) => zoom(4, ...shareAt(event)));
  slider.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && zoomed.scale === 1) return;  // the page scrolls
    event.preventDefault();
    zoom(2 ** (-event.deltaY / 200), ...shareAt(event));
  }, { passive: false });
}
