// The table of figures, sorted by the clicked heading.

// columns: [{ title, value(row) -> number, string or null, text(value), best: "low" or "high", gate }];
// a gate's value must be 0, and fails(row) false if it is there.
function showTable(table, columns, rows, tagOf) {
  const body = make("tbody");

  const cell = (column, row) => {
    const value = column.value(row);
    const text = value === null ? "\u2013" : column.text ? column.text(value) : value;
    const data = make("td", value === null ? {} : { "data-value": value }, text);
    if (column.gate && value !== null) data.className = value === 0 && !column.fails?.(row) ? 'good' : 'bad';
    return data;
  };
  const cellsOf = (row) => {
    if (!row.refused) return columns.map((column) => cell(column, row));
    return [cell(columns[0], row), make("td", { class: "refused", colspan: columns.length - 1 }, `refused: ${row.refused}`)];
  };
  const lines = rows.map((row) => {
    const line = make("tr", {}, ...cellsOf(row));
    const tag = tagOf(row);
    if (tag) line.firstChild.append(" ", make("span", { class: "tag" }, tag));
    return { row, line };
  });

  // Missing figures come last in both directions.
  const compare = (a, b, sign) => {
    if (a === null || b === null) return (a === null) - (b === null);
    return sign * (typeof a === "string" ? a.localeCompare(b) : a - b);
  };
  const sortBy = (column, direction) => {
    const sign = direction === "ascending" ? 1 : -1;
    lines.sort((a, b) => compare(column.value(a.row), column.value(b.row), sign));
    body.replaceChildren(...lines.map(({ line }) => line));
    for (const heading of headings) heading.removeAttribute("aria-sort");
    headings[columns.indexOf(column)].setAttribute("aria-sort", direction);
  };

  const headings = columns.map((column) => {
    const button = make("button", { type: "button" }, column.title);
    const heading = make("th", { scope: "col" }, button);
    button.addEventListener("click", () => {
      const first = column.best === "high" ? "descending" : "ascending";
      const second = first === "ascending" ? "descending" : "ascending";
      sortBy(column, heading.getAttribute("aria-sort") === first ? second : first);
    });
    return heading;
  });
  table.replaceChildren(make("thead", {}, make("tr", {}, ...headings)), body);
  sortBy(columns[1], "ascending");
}

// The tables in an element as text, in the order shown: Markdown has what is read, CSV the numbers behind it.
function tableText(element, format) {
  const tables = element.matches("table") ? [element] : [...element.querySelectorAll("table")];
  const textOf = (cell) => [...(cell.querySelector("div, span:not(.tag)") ? cell.querySelectorAll("div, span") : [cell])]
    .map((part) => part.textContent.trim()).join(" ").replace(/\s+/g, " ");
  const field = (cell) => {
    const text = cell.dataset.value ?? textOf(cell);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return tables.map((table) => [...table.rows].map((row, i) => {
    if (format === "CSV") return `${[...row.cells].map(field).join(",")}\n`;
    const line = `| ${[...row.cells].map((cell) => textOf(cell).replaceAll("|", "\\|")).join(" | ")} |\n`;
    return i > 0 ? line : `${line}|${[...row.cells].map((_, k) => (k ? " ---: |" : " --- |")).join("")}\n`;
  }).join("")).join("\n");
}

function copyButtons(element) {
  return ["Markdown", "CSV"].map((format) => {
    const button = make("button", { type: "button", class: "copy" }, `Copy as ${format}`);
    button.addEventListener("click", async () => {
      const text = tableText(element(), format);
      let done = true;
      try {
        await navigator.clipboard.writeText(text);
      } catch {  // a page without the right to
        const area = make("textarea", {});
        area.value = text;
        document.body.append(area);
        area.select();
        done = document.execCommand("copy");
        area.remove();
      }
      button.textContent = done ? `Copied as ${format}` : "Not allowed to copy";
    });
    return button;
  });
}
