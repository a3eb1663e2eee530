// Shows how the default's error is divided among its approximations.

// A bar from the middle for settings that grow the error, and to the right for settings that reduce it.
function shareBar(share) {
    const size = Math.min(1, Math.abs(share)) * 100;
    return html("span", {class: "share-bar", "aria-hidden": "true"},
        html("span", {class: share < 0 ? "grows" : "goes", style: `width: ${size.toFixed(1)}%`}));
}

// `removed` is of the report's errorParts, or {bias, noise} alone.
function partRow(name, removed, kind = null) {
    const point = pointById.get(removed.point);
    const cell = (share) => html("td", {}, isNumber(share) ? [shareBar(share), percent(share)] : "");
    return html("tr", {class: kind},
        html("th", {scope: "row"}, point ? html("button", {type: "button", class: "link", onclick: () => change({selected: point.id})}, name) : name),
        cell(removed.bias), cell(removed.noise),
        html("td", {}, removed.removed ? `${percent(removed.removed.median)} [${percent(removed.removed.low)}, ${percent(removed.removed.high)}]` : ""),
        html("td", {}, point?.ratio ? ratioText(point.ratio) : "", point?.timeTie ? html("span", {class: "tie"}, "tie") : null),
        html("td", {}, point ? errorText(point, metricOf(state.metric)) : ""));
}

function showErrorParts() {
    const all = report.errorParts;
    if (!all || all.parts.length === 0) {
        hideSection("error-parts");
        return;
    }
    const rows = [
        ...all.parts.map((part) => partRow(`${part.setting} ${part.to} instead of ${part.from}`, part)),
        partRow("any number of samples", {noise: all.noise}),
        partRow("the rest", {bias: all.rest}),
        ...(all.exact ? [partRow("all these values together, same samples", all.exact, "sum")] : []),
    ];
    const columns = ["Exact value alone", "Bias that goes", "Noise that goes", "Both", "Time over default", signedName(metricOf(state.metric))];
    byId("error-parts-table").replaceChildren(
        html("thead", {}, html("tr", {}, columns.map((name) => html("th", {scope: "col"}, name)))),
        html("tbody", {}, rows));
    byId("error-parts-note").textContent =
        `Errors are measured against ${report.reference?.what ?? "the reference"}. Each row gives one setting the reference's value and leaves the others as they are. ` +
        `Shares are of the default's error, ${ownMetric().name}${ownMetric().key === "rmse" ? " squared" : ""}: bias is what no number of samples takes away, and noise is the rest of the error. ` +
        "Below 0 the error grows. The rest is bias that no single value takes away: above 0, several have to be exact together; below 0, the shares overlap.";
}
