// The before/after slider: any two pictures, cut where the range input says.

// groups: [{ label, choices: [{ label, url, note }] }]; left and right: the labels shown first.
function showSlider(groups, left, right) {
  const choices = groups.flatMap((group) => group.choices);
  if (choices.length === 0) {
    byId("slider").closest("section").hidden = true;
    return;
  }

  const show = (side) => {
    const choice = choices[byId(`${side}-picture`).value];
    byId(`${side}-image`).src = choice.url;
    byId(`${side}-image`).alt = choice.label;
    const notes = ["left", "right"].map((s) => choices[byId(`${s}-picture`).value]?.note).filter(Boolean);
    byId("slider-legend").textContent = [...new Set(notes)].join(" ");
  };

  for (const [side, first] of [["left", left], ["right", right]]) {
    const select = byId(`${side}-picture`);
    for (const group of groups) {
      const options = group.choices.map((c) => make("option", { value: choices.indexOf(c) }, c.label));
      select.append(make("optgroup", { label: group.label }, ...options));
    }
    select.value = Math.max(0, choices.findIndex((choice) => choice.label === first));
    select.addEventListener("change", () => show(side));
  }
  show("left");
  show("right");

  const cut = byId("cut");
  const move = () => byId("slider").style.setProperty("--cut", `${cut.value}%`);
  cut.addEventListener("input", move);
  move();
}
