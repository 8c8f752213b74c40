// Where the plan changed along the camera's path.

const MOST_CHANGES_SHOWN = 20;

// Changes of one frame with one reason are one line: [{ frame, effects, to, why, rows }].
function linesOfChanges(changes) {
  const lines = new Map();
  for (const { frame, effect, to, why, rows } of changes) {
    const key = JSON.stringify([frame, to, why, rows]);
    if (!lines.has(key)) lines.set(key, { frame, effects: [], to, why, rows });
    lines.get(key).effects.push(effect);
  }
  return [...lines.values()];
}

function tableOfChanges(view, lines) {
  const cells = ({ frame, effects, to, why, rows }) => [
    wholeNumber(frame),
    effects.join(", ") + (rows ? ` (${rows.map((row) => view.page.rows[row].name).join(", ")})` : ""),
    `${to === "on" ? "off" : "on"} \u2192 ${to}`,
    why,
  ];
  const line = (tag, texts) => make("tr", {}, ...texts.map((text) => make(tag, {}, text)));
  return make("div", { class: "scrolls" }, make("table", { class: "changes" },
    make("thead", {}, line("th", ["Frame", "Effects", "Plan", "Why"])),
    make("tbody", {}, ...lines.map((change) => line("td", cells(change))))));
}

function showPlanChanges(view) {
  const part = byId("plan-changes"), moving = view.results.moving;
  part.hidden = !moving;
  part.replaceChildren();
  if (!moving) return;
  part.append(make("h3", {}, "Changed along the path"));
  const lines = linesOfChanges(moving.plan_changes);
  const shown = lines.slice(0, MOST_CHANGES_SHOWN), rest = lines.slice(MOST_CHANGES_SHOWN);
  part.append(lines.length > 0 ? tableOfChanges(view, shown) : make("p", {}, "All frames have one plan."));
  if (rest.length === 0) return;
  const summary = make("summary", {}, `${wholeNumber(rest.length)} more`);
  part.append(make("details", {}, summary, tableOfChanges(view, rest)));
}
