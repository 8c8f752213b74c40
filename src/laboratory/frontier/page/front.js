// Points of a scene over two quantities, with the front as a step line. The pointer takes the nearest point, arrow keys go from
// left to right.

const FRONT_MARGIN = { left: 62, right: 18, top: 34, bottom: 52 };
const REACH = 30;       // pixels from which the pointer takes a point

function tipOf(point, { x, y, reference }) {
  const lines = [make("p", {}, make("strong", {}, nameElement(point.label)))];
  const add = (text) => lines.push(make("p", {}, text));
  if (point.external) add(externalInWords(point));
  if (point.relative_time.runs > 0) add(`${intervalInWords(point.relative_time, "")} times ${page.baseline}, ${intervalInWords(point.frame_ms, " ms")}`);
  for (const q of new Set([frontQuantity(reference), y, x])) if (!q.time) add(`${q.title}: ${q.value(point) === null ? "unknown" : q.text(q.value(point))}`);
  const settings = Object.entries(point.settings).map(([key, value]) => `${key} ${value}`).join(", ");
  if (settings) lines.push(make("p", { class: "quiet" }, settings));
  if (point.relative_time.modes.length) add(modesInWords(point.relative_time));
  if (point.relative_device_time.runs > 0) add(`By the devices' clocks ${intervalInWords(point.relative_device_time, "")} times, ${intervalInWords(point.device_ms, " ms")}`);
  if (x.clock && y === frontQuantity(reference)) add(onFrontInWords("", frontOfPoint(point, reference, x.clock).probability, "On"));
  if (x.clock && y === frontQuantity(reference)) add(overViewsInWords(point, reference));
  return lines;
}

// Where the front is with a probability of 95 % at each error: between two step lines, from the smallest error up.
function bandElement({ scene, reference, x }, xAxis, yAxis, area) {
  const steps = x.clock.bands.find((band) => band.scene === scene && band.of === reference)?.steps ?? [];
  const within = (place, a, b) => Math.min(Math.max(place, Math.min(a, b)), Math.max(a, b));
  const edge = (end) => steps.flatMap(({ flip, ci95 }, i) => {
    const at = within(xAxis.at(ci95[end]), area.left, area.right), y = within(yAxis.at(flip), area.top, area.bottom);
    const next = i + 1 < steps.length ? within(yAxis.at(steps[i + 1].flip), area.top, area.bottom) : area.top;
    return [[at, y], [at, next]];
  });
  const outline = [...edge(0), ...edge(1).reverse()];
  return polyline(outline, { class: "band" });
}

// A point of the front over other views: 95 % intervals in both directions, and the share of draws in which it is on the front.
function overViewsElements({ point, at: [x, y] }, { reference, x: { clock } }, xAxis, yAxis, area, withShare) {
  const within = (place, a, b) => Math.min(Math.max(place, Math.min(a, b)), Math.max(a, b));
  const [low, high] = clock.relative(point).views_ci95 ?? [null, null], [least, most] = point.error.over_views_ci95?.[reference]?.displayed_flip ?? [null, null];
  const share = frontOverViews(point, reference);
  return [...(low === null ? [] : [make("line", { class: "over-views", x1: within(xAxis.at(low), area.left, area.right), x2: within(xAxis.at(high), area.left, area.right), y1: y, y2: y })]),
    ...(least === null ? [] : [make("line", { class: "over-views", x1: x, x2: x, y1: within(yAxis.at(least), area.top, area.bottom), y2: within(yAxis.at(most), area.top, area.bottom) })]),
    ...(share === null || !withShare ? [] : [make("text", { class: "share", x: x + 8, y: y - 8 }, `${Math.round(100 * share)} %`)])];
}

const floorElements = (at, text, { left, right }) => [make("line", { class: "floor", x1: left, x2: right, y1: at, y2: at }),
  make("text", { x: right - 4, y: at - 5, "text-anchor": "end" }, `surfaces of the two rasterizers differ by ${text}`)];

const NARROW = 640;  // pixels of width below which points of the front have numbers instead of names

// Short: without the technique if all points of the front share it, and without settings that others imply.
function frontName(label, shared) {
  const [technique, settings] = [label.split(":")[0], label.split(":").slice(1).join(":")];
  const short = settings.replace(/^range=cutoff,(?=.*cutoff=)/, "").replaceAll(",", ", ");
  return shared ? short || "default settings" : short ? `${technique}: ${short}` : technique;
}

const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
const boxAround = ([x, y], half) => ({ left: x - half, right: x + half, top: y - half, bottom: y + half });

// Boxes of the front's lines.
const stepBoxes = (steps) => steps.slice(1).map((at, i) => ({ left: Math.min(at[0], steps[i][0]) - 1, right: Math.max(at[0], steps[i][0]) + 1,
  top: Math.min(at[1], steps[i][1]) - 1, bottom: Math.max(at[1], steps[i][1]) + 1 }));

// Names beside the points of the front where nothing of `taken` is; the other points get a number. Returns the texts and the numbered points.
function nameFront(front, marks, taken, area, narrow) {
  const texts = [], numbered = [];
  taken.push(...marks.map(({ at }) => boxAround(at, 5)));
  const shared = front.every(({ point }) => point.technique === front[0].point.technique);
  const place = (text, [x, y]) => {
    const width = 6.4 * text.length;
    const spots = [[x + 10, y + 4], [x + 10, y + 17], [x - 10 - width, y + 4], [x - 10 - width, y + 17], [x - 10 - width, y - 9], [x + 10, y - 22], [x + 10, y + 30], [x - 10 - width, y - 22]];
    const boxes = spots.map(([left, base]) => ({ left, right: left + width, top: base - 11, bottom: base + 3 }));
    const i = boxes.findIndex((box) => box.left >= area.left && box.right <= area.right && box.top >= area.top - 14 && box.bottom <= area.bottom && !taken.some((other) => overlap(box, other)));
    if (i < 0) return false;
    taken.push(boxes[i]);
    texts.push(make("text", { class: "point-name", x: spots[i][0], y: spots[i][1] }, text));
    return true;
  };
  for (const { point, at } of front) {
    if (!narrow && place(frontName(point.label, shared), at)) continue;
    numbered.push(point);
    place(String(numbered.length), at);
  }
  return { texts, numbered };
}

// state: { points, x, y, reference, hidden: set of techniques, selected: point }; choose(point) is called at a click. Returns a function that
// draws the state.
function startFront(container, state, choose) {
  const tip = make("div", { class: "tip", role: "status" });
  let shown = [], hovered = null;

  function hover(entry) {
    if (hovered === entry) return;
    hovered = entry;
    for (const { element, point } of shown) {
      element.classList.toggle("hovered", entry !== null && point === entry.point);
    }
    tip.hidden = entry === null;
    if (entry === null) return;
    tip.replaceChildren(...tipOf(entry.point, state));
    tip.style.left = tip.style.top = "0";
    const left = entry.at[0] + 14, top = entry.at[1] + 14;
    tip.style.left = `${Math.max(4, Math.min(left, container.clientWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${top + tip.offsetHeight > container.clientHeight ? Math.max(4, entry.at[1] - tip.offsetHeight - 14) : top}px`;
  }

  function nearest(event) {
    const box = container.getBoundingClientRect();
    const away = ({ at }) => Math.hypot(event.clientX - box.left - container.clientLeft - at[0], event.clientY - box.top - container.clientTop - at[1]);
    const best = shown.reduce((a, b) => (a === null || away(b) < away(a) ? b : a), null);
    return best !== null && away(best) <= REACH ? best : null;
  }

  container.addEventListener("pointermove", (event) => hover(nearest(event)));
  container.addEventListener("pointerleave", () => hover(null));
  container.addEventListener("blur", () => hover(null));
  container.addEventListener("click", (event) => {
    const entry = nearest(event);
    if (entry) choose(entry.point);
  });
  container.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const inOrder = [...shown].sort((a, b) => a.at[0] - b.at[0] || b.at[1] - a.at[1]);
    if (step && inOrder.length) {
      const now = inOrder.indexOf(hovered);
      hover(inOrder[now < 0 ? (step > 0 ? 0 : inOrder.length - 1) : (now + step + inOrder.length) % inOrder.length]);
    } else if ((event.key === "Enter" || event.key === " ") && hovered) {
      choose(hovered.point);
    } else if (event.key === "Escape") {
      hover(null);
    } else {
      return;
    }
    event.preventDefault();
  });

  return () => {
    const { x, y } = state, { left, right, top, bottom } = FRONT_MARGIN;
    const width = Math.max(280, container.clientWidth), height = Math.round(Math.min(540, Math.max(340, width * 0.6)));
    const area = { left, right: width - right, top, bottom: height - bottom };
    const placed = state.points.filter((point) => !state.hidden.has(point.technique) && x.value(point) !== null && y.value(point) !== null);
    const floor = surfacesFloor(state.points, y), parted = floor !== null && placed.some((point) => y.value(point) < floor);  // where it matters
    const xAxis = logAxis(placed.map(x.value), area.left, area.right);
    const yAxis = logAxis([...placed.map(y.value), ...(parted ? [floor] : [])], area.bottom, area.top);
    const onFront = frontOf(placed, x, y);
    shown = placed.map((point, i) => ({ point, onFront: onFront[i], at: [xAxis.at(x.value(point)), yAxis.at(y.value(point))] }));
    const front = shown.filter((entry) => entry.onFront).sort((a, b) => a.at[0] - b.at[0]);
    const steps = front.flatMap(({ at }, i) => (i ? [[at[0], front[i - 1].at[1]], at] : [at]));
    const banded = x.clock && y === frontQuantity(state.reference) && state.hidden.size === 0;
    for (const entry of shown) {
      entry.element = markerElement(entry.point.technique, { class: `point${entry.onFront ? " on-front" : ""}${entry.point === state.selected ? " selected" : ""}`,
        ...moveTo(...entry.at), "data-label": entry.point.label,
        "data-title": `${entry.point.label}: ${x.title} ${x.text(x.value(entry.point))}; ${y.title} ${y.text(y.value(entry.point))}` });
    }
    const inFront = [...shown].sort((a, b) => a.onFront - b.onFront);
    const names = page.techniques.filter((technique) => placed.some((point) => point.technique === technique));
    const narrow = width < NARROW, withViews = banded && x.key.startsWith("relative");
    const shares = withViews && !narrow ? front.filter(({ point }) => frontOverViews(point, state.reference) !== null)
      .map(({ at: [markX, markY] }) => ({ left: markX + 8, right: markX + 36, top: markY - 19, bottom: markY - 8 })) : [];
    const { texts, numbered } = nameFront(front, shown, [...shares, ...stepBoxes(steps)], area, narrow);
    const svg = drawing(width, height, `${y.title} against ${x.title}`, ...acrossAxis(xAxis, x.title, area), ...alongAxis(yAxis, y.title, area),
      ...(banded ? [bandElement(state, xAxis, yAxis, area)] : []), polyline(steps, { class: "step" }),
      ...(withViews ? front.flatMap((entry) => overViewsElements(entry, state, xAxis, yAxis, area, !narrow)) : []),
      ...(parted ? floorElements(yAxis.at(floor), y.text(floor), area) : []), ...inFront.map(({ element }) => element), ...texts,
      ...shown.filter(({ point }) => x.time && (x.clock ?? WALL).relative(point).modes.length).map(({ at }) => make("text", { class: "modes", x: at[0] + 7, y: at[1] - 5 }, "2")),
      make("g", { class: "only-file" }, ...markedNames(names.map((technique) => ({ technique, text: technique })), left, height + 12, 3, width - left)));
    svg.dataset.fileHeight = height + 20 * Math.ceil(names.length / 3) + 10;
    container.replaceChildren(svg, tip);
    const before = hovered?.point;
    hovered = undefined;
    hover(shown.find(({ point }) => point === before) ?? null);
    return { shown: shown.length, missing: state.points.length - placed.length, floor, parted, numbered };
  };
}
