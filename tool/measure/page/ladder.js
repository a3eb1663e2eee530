// Shows one setting, value by value: error and time, and the pictures beside the reference.

const LADDER_COLORS = ["var(--blue)", "var(--front)", "var(--green)", "var(--purple)", "var(--orange)"];
const MOST_LADDERS = 5;

// Returns the lines of a setting: the points that differ by it alone, the default's first. Each is {name, steps}
// with {value, point} in the order of the values.
function laddersOf(setting) {
    const lines = new Map();
    for (const point of points) {
        if (!isMeasured(point) || point.package || point.filteredFrames > 0 || ["search", "exact"].includes(point.kind)) {
            continue;
        }
        const others = Object.entries(point.settings ?? {}).filter(([name]) => name !== setting.name);
        const name = others.map(([other, value]) => `${other} ${value}`).join(", ");
        const at = setting.values.findIndex((value) => String(value) === valueAt(point, setting));
        if (at >= 0) {
            const line = lines.get(name) ?? {name: name || "the default's other settings", own: name === "", steps: []};
            line.steps.push({at, value: valueAt(point, setting), point});
            lines.set(name, line);
        }
    }
    return [...lines.values()].filter(({steps}) => steps.length > 1)
        .sort((a, b) => Number(b.own) - Number(a.own) || b.steps.length - a.steps.length).slice(0, MOST_LADDERS)
        .map((line) => ({...line, steps: line.steps.sort((a, b) => a.at - b.at)}));
}

function showLadders() {
    const chosen = settings.filter((setting) => laddersOf(setting)[0]?.steps.length > 2);
    if (chosen.length === 0) {
        hideSection("ladder");
        return;
    }
    const first = ["bounces", "lights", "spp"].find((name) => chosen.some((setting) => setting.name === name)) ?? chosen[0].name;
    fillSelect(byId("ladder-of"), chosen.map(({name, what}) => [name, `${name}: ${what}`]), first, fillLines);
    fillLines();
}

function chosenSetting() {
    return settings.find(({name}) => name === byId("ladder-of").value);
}

function fillLines() {
    const lines = laddersOf(chosenSetting());
    const select = byId("ladder-line");
    // Pictures are of the most exact line unless the user asks for another: the effect of a value shows best
    // there.
    const best = lines.reduce((least, line, i) => (leastError(line) < leastError(lines[least]) ? i : least), 0);
    select.replaceChildren(...lines.map(({name}, i) => html("option", {value: i}, name)));
    select.value = String(best);
    select.onchange = drawLadderPictures;
    drawLadder();
    drawLadderPictures();
}

function leastError({steps}) {
    return Math.min(...steps.map(({point}) => inexactness(point, metricOf(state.metric))));
}

function drawLadder() {
    if (byId("ladder").hidden) {
        return;
    }
    const setting = chosenSetting();
    const lines = laddersOf(setting);
    const metric = metricOf(state.metric);
    const values = setting.values.map(String);
    const box = byId("ladder-box");
    const whole = Math.max(300, Math.floor(box.clientWidth));
    const width = whole < 700 ? whole : Math.floor(whole / 2) - 8;
    const error = (point) => errorOf(point, metric);
    const time = ({time}) => (time ? {value: time.median, low: time.low, high: time.high} : null);
    box.replaceChildren(
        ladderChart(width, values, lines, error, metric.log, `${metric.name}${metric.unit ? `, ${metric.unit}` : ""}`, setting),
        ladderChart(width, values, lines, time, true, "time of one picture, ms", setting));
    byId("ladder-legend").replaceChildren(...lines.map(({name}, i) =>
        legendEntry(name, svg("path", {d: "M-9,0H9", stroke: LADDER_COLORS[i], "stroke-width": 3}))));
}

// Draws the result of `of` for each step against the values, which are evenly spread.
function ladderChart(width, values, lines, of, log, name, setting) {
    const height = 260;
    const onAxis = (value) => isNumber(value) && (!log || value > 0);
    const extents = lines.flatMap(({steps}) => steps.flatMap(({point}) => Object.values(of(point) ?? {}))).filter(onAxis);
    const [low, high] = paddedExtent(extents.length > 0 ? extents : [1, 10], log);
    const y = makeScale({log, low, high, from: height - MARGIN.bottom, to: MARGIN.top, ticks: 5});
    const step = (width - MARGIN.left - MARGIN.right) / Math.max(1, values.length);
    const x = (at) => MARGIN.left + step * (at + 0.5);
    const right = width - MARGIN.right;
    const within = (value) => y(Math.min(Math.max(onAxis(value) ? value : low, low), high));
    return svg("svg", {class: "ladder", width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
                       "aria-label": `${name} by ${setting.name}: ${lines.map((line) => ladderText(line, of)).join("; ")}`},
        svg("g", {class: "axes"},
            y.ticks.map((tick) => [svg("path", {class: "grid", d: `M${MARGIN.left},${y(tick)}H${right}`}),
                                   svg("text", {x: MARGIN.left - 8, y: y(tick) + 4, "text-anchor": "end"}, tickText(tick))]),
            values.map((value, at) => svg("text", {x: x(at), y: height - MARGIN.bottom + 18, "text-anchor": "middle"}, shorten(value, 14))),
            svg("path", {class: "axis", d: `M${MARGIN.left},${MARGIN.top}V${height - MARGIN.bottom}H${right}`}),
            svg("text", {class: "axis-name", x: (MARGIN.left + right) / 2, y: height - 6, "text-anchor": "middle"}, `--${setting.name}`),
            svg("text", {class: "axis-name", transform: `translate(14 ${(MARGIN.top + height - MARGIN.bottom) / 2}) rotate(-90)`, "text-anchor": "middle"}, name)),
        lines.map(({steps}, i) => {
            const shown = steps.map(({at, point}) => ({at, value: of(point)})).filter(({value}) => value && onAxis(value.value));
            return svg("g", {class: "ladder-line"},
                svg("path", {d: `M${shown.map(({at, value}) => `${x(at)},${y(value.value)}`).join("L")}`, fill: "none", stroke: LADDER_COLORS[i], "stroke-width": 2}),
                shown.map(({at, value}) => [
                    svg("path", {class: "whisker", d: `M${x(at)},${within(value.low)}V${within(value.high)}`}),
                    svg("circle", {class: "step", cx: x(at), cy: y(value.value), r: 4, fill: LADDER_COLORS[i]})]));
        }));
}

function ladderText({name, steps}, of) {
    return `${name}: ${steps.map(({value, point}) => `${value} ${number(of(point)?.value)}`).join(", ")}`;
}

function drawLadderPictures() {
    const line = laddersOf(chosenSetting())[Number(byId("ladder-line").value)];
    const metric = metricOf(state.metric);
    const reference = imageUri(report.reference?.image);
    const figure = (uri, name, caption, id) => html("figure", {"data-id": id}, picture(uri, name),
        html("figcaption", {}, html("strong", {}, name), caption));
    byId("ladder-pictures").replaceChildren(
        ...(line?.steps ?? []).filter(({point}) => hasImage(point)).map(({value, point}) =>
            figure(imageUri(point.image), `${byId("ladder-of").value} ${value}`,
                   ` ${milliseconds(point.time.median)}, ${signedName(metric)} ${errorText(point, metric)}`, point.id)),
        ...(reference ? [figure(reference, "reference", ` ${report.reference.what ?? ""}`, null)] : []));
}
