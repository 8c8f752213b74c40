// Reads what the frontier page shows of a point of another renderer.
addEventListener("load", () => {
  const seen = { faults, shapes: {}, cells: {} };
  for (const mark of document.querySelectorAll("#front .point")) seen.shapes[mark.dataset.label] = mark.getAttribute("d");
  const columns = [...document.querySelectorAll("#figures-table th")].map((heading) => heading.textContent);
  const button = [...document.querySelectorAll("#figures-table button")].find(({ textContent }) => textContent === "deferred");
  [...button.closest("tr").cells].forEach((cell, i) => { seen.cells[columns[i]] = cell.textContent; });
  button.click();
  seen.summary = document.querySelector("#chosen .summary").textContent;
  seen.paragraph = document.getElementById("paragraph").textContent;
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
});
