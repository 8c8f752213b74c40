// Reads what the page of a race shows.
addEventListener("load", () => {
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify({ faults, title: byId("scene").textContent, view: byId("view").textContent,
    verdict: byId("verdict").textContent, changes: [...byId("changes").children].map((item) => item.textContent),
    rows: [...byId("points").tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent)) });
  document.body.append(outcome);
});
