// The before/after slider: any two pictures, cut at the position of the range input.

let sliderChoices = [];

function showSliderSide(side) {
  const chosen = (s) => sliderChoices[byId(`${s}-picture`).value];
  byId(`${side}-image`).src = chosen(side).url;
  byId(`${side}-image`).alt = chosen(side).label;
  const notes = ["left", "right"].map((s) => chosen(s)?.note).filter(Boolean);
  byId("slider-legend").textContent = [...new Set(notes)].join(" ");
}

// groups: [{ label, choices: [{ label, url, note }] }]; left and right: the labels shown first.
function showSlider(groups, left, right) {
  sliderChoices = groups.flatMap((group) => group.choices);
  byId("slider").closest("section").hidden = sliderChoices.length === 0;
  if (sliderChoices.length === 0) return;
  for (const [side, first] of [["left", left], ["right", right]]) {
    const select = byId(`${side}-picture`);
    select.replaceChildren(...groups.map((group) => make("optgroup", { label: group.label },
      ...group.choices.map((c) => make("option", { value: sliderChoices.indexOf(c) }, c.label)))));
    select.value = Math.max(0, sliderChoices.findIndex((choice) => choice.label === first));
  }
  showSliderSide("left");
  showSliderSide("right");
}

function startSlider() {
  for (const side of ["left", "right"]) byId(`${side}-picture`).addEventListener("change", () => showSliderSide(side));
  const cut = byId("cut");
  const move = () => byId("slider").style.setProperty("--cut", `${cut.value}%`);
  cut.addEventListener("input", move);
  move();
}
