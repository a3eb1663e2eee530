// The heading: sentences that name the measured scene and the result.

function showHeading() {
    const scene = report.scene ?? {};
    const machine = report.machine ?? {};
    const name = scene.name || scene.file || "a scene";
    document.title = `${name}: what accuracy costs in time`;
    byId("title").textContent = name;
    byId("subtitle").textContent = `What accuracy costs in time, on ${machine.device ?? "an unknown device"}.`;
    const facts = [
        ["Scene", [scene.file, scene.triangles !== undefined && plural(scene.triangles, "triangle"),
                   scene.materials !== undefined && plural(scene.materials, "material"),
                   scene.instances !== undefined && plural(scene.instances, "instance"),
                   scene.lights !== undefined && plural(scene.lights, "light")]],
        ["Picture", [`${scene.width} × ${scene.height} pixels`, scene.camera && `camera ${scene.camera}`,
                     scene.environment ? `environment ${scene.environment}` : "no environment map"]],
        ["Device", [machine.device, machine.deviceType, (machine.tracers ?? []).join(" and ")]],
        ["Driver", [machine.driver]],
        ["Host", [machine.cpu, machine.cores && plural(machine.cores, "core"), machine.os]],
        ["Glint", [report.tool, report.commit && `commit ${report.commit}`]],
        ["Date", [report.date?.replace("T", " ").replace("Z", " UTC")]],
    ];
    byId("facts").replaceChildren(...facts.flatMap(([term, parts]) => {
        const text = parts.filter((part) => part).join(", ");
        return text ? [html("div", {}, html("dt", {}, term), html("dd", {}, text))] : [];
    }));
    byId("command").textContent = report.command ?? "";
    copyButton(byId("copy-command"), report.command ?? "");
    byId("summary").replaceChildren(...summarySentences().map((sentence) => html("li", {}, sentence)));
    byId("footer").textContent = `Made by glint bench ${report.tool ?? ""}. This file is complete: it opens without a network.`;
    byId("contents").replaceChildren(...[...document.querySelectorAll("main > section")].map((section) =>
        html("a", {href: `#${section.id}`}, section.querySelector("h2").textContent)));
}

function comparedToDefault(point) {
    if (point === defaultPoint || !point.ratio) {
        return "";
    }
    return point.timeTie ? ", a tie in time with the default"
        : `, ${number(point.ratio.median)} times the time of the default`;
}

function summarySentences() {
    const metric = ownMetric();
    const measured = points.filter((point) => isMeasured(point) && errorOf(point, metric));
    if (measured.length === 0) {
        return ["No point has both a time and an error."];
    }
    const least = (value) => measured.reduce((best, point) => (value(point) < value(best) ? point : best));
    const fastest = least(timeOf);
    const exact = least((point) => inexactness(point, metric));
    const describe = (point) => `${milliseconds(point.time.median)}, ${metric.name} ${errorText(point, metric)}`;
    const sentences = [
        `Fastest: ${fastest.name} (${describe(fastest)})${comparedToDefault(fastest)}.`,
        `Most exact: ${exact.name} (${describe(exact)})${comparedToDefault(exact)}.`,
    ];
    if (defaultPoint && measured.includes(defaultPoint)) {
        const onFront = frontFor(metric).includes(defaultPoint.id);
        sentences.push(`The default takes ${describe(defaultPoint)}; it is ${onFront ? "" : "not "}on the Pareto front.`);
    }
    return [...sentences, ...adviceSentences(), ...strategySentences()];
}

function adviceSentences() {
    const advice = report.advice;
    if (!advice) {
        return [];
    }
    const limits = [];
    if (isNumber(advice.budgetMs)) {
        limits.push(`a budget of ${milliseconds(advice.budgetMs)}`);
    }
    if (isNumber(advice.maxError)) {
        limits.push(`a ${metricOf(advice.metric).name} of at most ${number(advice.maxError)}`);
    }
    const goal = limits.length > 0 ? `For ${limits.join(" and ")}` : "Advice";
    const point = pointById.get(advice.point);
    const file = point && advice.file ? ` The settings are in ${advice.file}.` : "";
    return [`${goal}: ${advice.why ?? (point ? point.name : "nothing fits")}${file}`];
}

function strategySentences() {
    const strategies = report.strategies;
    const fastest = strategies?.fastest ?? [];
    if (fastest.length === 0) {
        return [];
    }
    const verdict = fastest.length === 1 ? `The fastest strategy is ${fastest[0]}`
        : `The fastest strategies, a tie, are ${sentenceList(fastest)}`;
    return [`${verdict}${strategies.tracer ? `, traced by ${strategies.tracer}` : ""}. Below stands why.`];
}
