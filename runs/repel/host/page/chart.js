// SPDX-License-Identifier: BSD-3-Clause
// Goes into each page with charts: draws them by uPlot from the data beside them. Charts of time
// share the moment at the pointer and the zoom.
(() => {
  "use strict";
  const tint = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const shown = (value, unit) =>
    value == null ? "\u2013" : `${Number(value.toPrecision(5))} ${unit}`.trim();

  // Where the curve of `share` has room for its tail: each further nine is as wide as the last.
  const SHARES = [0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999];
  const decades = (share) => -Math.log10(Math.max(1 - share, 1e-5));
  const share = (x) => Number((100 * (1 - 10 ** -x)).toPrecision(7));

  // What is marked on an axis that narrows.
  const STEPS = [0, ...[10, 20, 50, 100, 200, 500, 1000, 2000].flatMap((y) => [y, -y])]
    .sort((a, b) => a - b);

  const AXES = {
    time: (data) => ({
      x: data.values[0].map((_, i) => data.from + data.step * i),
      scales: { x: { time: false }, y: {
        range: (_, low, high) => {
          const all = [low, high, ...data.lines].filter((value) => value != null);
          if (all.length === 0) return [0, 1];
          return uPlot.rangeNum(Math.min(...all), Math.max(...all), 0.05, true);
        },
        ...(data.even_to && { distr: 4, asinh: data.even_to }),
      } },
      upright: data.even_to && {
        splits: (u) => STEPS.filter((y) => y >= u.scales.y.min && y <= u.scales.y.max),
        filter: (_, splits) => splits,  // by default, powers of ten alone have labels
      },
      axis: { values: (_, at) => at.map((value) => shown(value, "s")) },
      name: "time",
      say: (value) => shown(value, "s"),
    }),
    share: (data) => ({
      x: data.shares.map(decades),
      scales: { x: { time: false }, y: { distr: 3, range: (_, low, high) => [
        10 ** Math.floor(Math.log10(low ?? 1)), 1.3 * Math.max(high ?? 10, ...data.lines),
      ] } },
      axis: {
        splits: (u) => SHARES.map(decades).filter(
          (x) => x >= u.scales.x.min - 1e-9 && x <= u.scales.x.max + 1e-9),
        values: (_, at) => at.map((x) => `p${share(x)}`),
      },
      name: "share of the ticks",
      say: (value) => (value == null ? "\u2013" : `${share(value)} %`),
    }),
  };

  // Dashed: values that matter, across, and moments, upright.
  const marks = (data) => (u) => {
    const { ctx, bbox } = u;
    const stroke = (colour, x1, y1, x2, y2) => {
      ctx.strokeStyle = tint(colour);
      ctx.beginPath();
      ctx.moveTo(x1, y1);
      ctx.lineTo(x2, y2);
      ctx.stroke();
    };
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const time of data.marks) {
      const x = u.valToPos(time, "x", true);
      stroke("--soft", x, bbox.top, x, bbox.top + bbox.height);
    }
    for (const value of data.lines) {
      const y = u.valToPos(value, "y", true);
      stroke("--ink", bbox.left, y, bbox.left + bbox.width, y);
    }
    ctx.restore();
  };

  function draw(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const place = figure.querySelector(".plot");
    const { x, scales, axis, upright, name, say } = AXES[data.kind](data);
    const line = { stroke: () => tint("--soft"), grid: { stroke: () => tint("--rule"), width: 1 },
                   ticks: { stroke: () => tint("--rule"), width: 1 } };
    const curves = data.names.map((label, i) => ({
      label, stroke: () => tint(`--c${i % 6}`), width: 1.4, points: { show: false },
      value: (_, value) => shown(value, data.unit),
    }));
    figure.chart?.destroy();
    figure.chart = new uPlot({
      width: place.clientWidth, height: 220, scales,
      axes: [{ ...line, ...axis }, { ...line, ...upright, size: 64, label: data.unit, labelSize: 20 }],
      series: [{ label: name, value: (_, value) => say(value) }, ...curves],
      cursor: { drag: { x: true, y: false }, sync: { key: data.kind } },
      hooks: { draw: [marks(data)] },
    }, [x, ...data.values], place);
    const labels = place.querySelectorAll(".u-series th");
    data.meanings?.forEach((meaning, i) => meaning && (labels[i + 1].title = meaning));
  }

  const figures = [...document.querySelectorAll("figure[data-chart]")];
  const draw_all = () => figures.forEach(draw);
  draw_all();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw_all);
  addEventListener("resize", () => {
    for (const figure of figures) {
      figure.chart.setSize({ width: figure.querySelector(".plot").clientWidth, height: 220 });
    }
  });
})();
