// A table of all points with their numbers, for readers who prefer that to the chart.

function showPointsTable() {
    const metrics = METRICS.filter((metric) => points.some((point) => errorOf(point, metric)));
    const order = points.filter(isMeasured).filter(isShown).sort((a, b) => timeOf(a) - timeOf(b));
    const front = new Set(frontFor(metricOf(state.metric)));
    byId("points-table").replaceChildren(
        html("thead", {}, html("tr", {}, ["Point", "Time, ms", "Over the default", ...metrics.map((metric) => signedName(metric) + (metric.unit ? `, ${metric.unit}` : ""))]
            .map((name) => html("th", {scope: "col"}, name)))),
        html("tbody", {}, order.map((point) => html("tr", {"data-id": point.id},
            html("th", {scope: "row"}, point.name, front.has(point.id) ? html("span", {class: "tie"}, "front") : ""),
            html("td", {}, `${number(point.time.median)} ${range(point.time)}`),
            html("td", {}, point === defaultPoint ? "1" : [ratioText(point.ratio), tieMark(point.timeTie)]),
            metrics.map((metric) => html("td", {}, errorText(point, metric)))))));
}
