// Shows which part of the default's error is which approximation.

// A bar from the middle for what grows the error, and to the right for what takes it away.
function shareBar(share) {
    const size = Math.min(1, Math.abs(share)) * 100;
    return html("span", {class: "share-bar", "aria-hidden": "true"},
        html("span", {class: share < 0 ? "grows" : "goes", style: `width: ${size.toFixed(1)}%`}));
}

function partRow(name, share, interval, point, {extra = ""} = {}) {
    const metric = metricOf(state.metric);
    return html("tr", {class: extra, "data-point": point?.id},
        html("th", {scope: "row"}, point ? html("button", {type: "button", class: "link", onclick: () => change({selected: point.id})}, name) : name),
        html("td", {}, shareBar(share)),
        html("td", {}, `${percent(share)}${interval ? ` [${percent(interval.low)}, ${percent(interval.high)}]` : ""}`),
        html("td", {}, point?.ratio ? ratioText(point.ratio) : "", point?.timeTie ? html("span", {class: "tie"}, "tie") : null),
        html("td", {}, point ? errorText(point, metric) : ""));
}

function showErrorParts() {
    const all = report.errorParts;
    if (!all || (all.parts.length === 0 && !isNumber(all.noise))) {
        hideSection("error-parts");
        return;
    }
    const part = ({setting, from, to, point, removed}) =>
        partRow(`${setting} ${to} instead of ${from}`, removed.median, removed, pointById.get(point));
    const rows = [
        ...all.parts.map(part),
        ...(isNumber(all.noise) ? [partRow("any number of samples: noise", all.noise, null, null)] : []),
        partRow("the rest", all.rest, null, null),
        ...(all.exact ? [partRow("all these values together, same samples", all.exact.removed.median, all.exact.removed,
                                 pointById.get(all.exact.point), {extra: "sum"})] : []),
    ];
    const columns = ["Exact value alone", "", "Share of the default's error that goes", "Time over default", signedName(metricOf(state.metric))];
    byId("error-parts-table").replaceChildren(
        html("thead", {}, html("tr", {}, columns.map((name) => html("th", {scope: "col"}, name)))),
        html("tbody", {}, rows));
    byId("error-parts-note").textContent =
        `Errors are measured against ${report.reference?.what ?? "the reference"}. Each row gives one setting the reference's value and leaves the others as they are. ` +
        "The rest is what no single value takes away: above 0, several have to be exact together; below 0, the shares overlap. " +
        `Shares are of ${ownMetric().name}${ownMetric().key === "rmse" ? ", squared" : ""}.`;
}
