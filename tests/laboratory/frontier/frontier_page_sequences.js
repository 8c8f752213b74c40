// Reads what the frontier page shows of sequences of frames.
addEventListener("load", () => {
  const texts = (selector) => [...document.querySelectorAll(selector)].map((element) => element.textContent);
  const seen = { faults, axes: texts("#y-choice option"), columns: texts("#figures-table th"), marks: [], table: [] };
  const title = "Flicker (FLIP), still camera";
  if (seen.axes.includes(title)) {
    const choice = document.getElementById("y-choice");
    choice.value = "still.plain";
    choice.dispatchEvent(new Event("change"));
    seen.marks = [...document.querySelectorAll("#front .point")].map(({ dataset }) => `${dataset.label}: ${dataset.title.split(`${title} `)[1]}`);
    [...document.querySelectorAll("#figures-table button")].find((button) => button.textContent === "deferred").click();
    seen.table = [...document.querySelectorAll("#chosen .sequences tr")].map((line) => [...line.cells].map((cell) => cell.textContent).join("|"));
  }
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
