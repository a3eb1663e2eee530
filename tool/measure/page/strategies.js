// Shows which strategy is fastest here, and why.

function showStrategies() {
    const rows = report.strategies?.rows ?? [];
    const box = byId("strategies-box");
    if (rows.length === 0) {
        box.replaceChildren(html("p", {}, "No strategies were compared."));
        return;
    }
    const fastest = report.strategies.fastest ?? [];
    const columns = [
        ["Strategy", (row) => [row.strategy, fastest.includes(row.strategy) ? html("span", {class: "tie"}, fastest.length > 1 ? "fastest, a tie" : "fastest") : ""]],
        ["Time, ms", (row) => `${number(row.time?.median)} ${range(row.time)}`],
        ["Over the default", (row) => ratioText(row.ratio)],
        ["Hits, ms", (row) => (row.hits ? `${number(row.hits.median)} ${range(row.hits)}` : NONE)],
        ["Hits over the default's", (row) => (row.hitRatio ? ratioText(row.hitRatio) : NONE)],
        ["Tracing, ms", (row) => number(row.traceMs)],
        ["Shading, ms", (row) => number(row.shadeMs)],
        ["Ordering, ms", (row) => number(row.orderMs)],
        ["Launches", (row) => count(row.launches)],
        ["Rays", (row) => count(row.rays)],
        ["Buckets filled", (row) => count(row.buckets)],
        ["Divergence", (row) => number(row.divergence)],
    ].filter(([, cell], index) => index < 2 || rows.some((row) => cell(row) !== NONE));
    box.replaceChildren(
        html("ul", {class: "why"}, (report.strategies.why ?? []).map((sentence) => html("li", {}, sentence))),
        html("div", {class: "scroll", tabindex: 0, role: "region", "aria-labelledby": "strategies-title"},
            html("table", {id: "strategies-table"},
                html("thead", {}, html("tr", {}, columns.map(([name]) => html("th", {scope: "col"}, name)))),
                html("tbody", {}, rows.map((row) => html("tr", {class: fastest.includes(row.strategy) ? "changed" : ""},
                    columns.map(([, cell], index) => (index === 0 ? html("th", {scope: "row"}, cell(row)) : html("td", {}, cell(row))))))))));
}
