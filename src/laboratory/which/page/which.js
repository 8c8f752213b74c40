// The page of `lightgrid which`: its answer, and all points of the race.

byId("scene").textContent = page.scene;
byId("view").textContent =
  `${page.size[0]} × ${page.size[1]}, ${wholeNumber(page.lights)} lights, ${page.machine.cl_device}, ${page.seconds.toFixed(0)} s, ${page.rounds} rounds`;
byId("changes").replaceChildren(...(page.changes ?? []).map(({ what, verdict }) => make("li", {}, `${what}: ${verdict}`)));

const estimateOf = (key) => (point) => point[key]?.estimate ?? null;
showTable(byId("points"), [
  { title: "point", value: (point) => point.label },
  { title: "ms", value: estimateOf("ms"), text: milliseconds },
  { title: "relative time", value: estimateOf("relative_time"), text: (value) => value.toFixed(3) },
  { title: "FLIP", value: (point) => point.flip, text: errorNumber },
  { title: "FLIP, reduced size", value: (point) => point.flip_reduced, text: errorNumber },
  { title: "rounds", value: (point) => point.rounds },
  { title: "fate", value: (point) => point.fate },
], page.points, (point) => (point.label === page.choice ? "fastest" : point.label === page.runner_up ? "next" : ""));
