// Reads the line of what surfaces differ by on several axes, and writes what it saw into <pre id="outcome">.
addEventListener("load", () => {
  const get = (id) => document.getElementById(id);
  const all = (selector, of) => [...document.querySelectorAll(selector)].map(of);
  const change = (id, value) => {
    get(id).value = value;
    get(id).dispatchEvent(new Event("change"));
  };
  const shown = () => ({ notes: get("front-notes").textContent, texts: all("#front text", (text) => text.textContent).filter((text) => text.includes("surfaces")),
    lines: all("#front .floor", (line) => [line.y1.baseVal.value, line.x2.baseVal.value - line.x1.baseVal.value]),
    marks: all("#front .point", ({ dataset, transform }) => ({ label: dataset.label, at: [transform.baseVal[0].matrix.e, transform.baseVal[0].matrix.f] })) });
  const seen = {};
  for (const axis of ["model.rmse_rel", "total.rmse_rel", "total.displayed_flip"]) {
    change("y-choice", axis);
    seen[axis] = shown();
  }
  change("y-choice", "total.max_rel");
  [...document.querySelectorAll("#techniques button")].find((button) => button.textContent === "deferred").click();
  seen.above = shown();
  change("y-choice", "total.displayed_flip");
  change("scene-choice", "terrain");
  seen.terrain = shown();
  seen.faults = faults;
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
