// A picture is a list of shapes, which is painted on a canvas or written as SVG.

/** Paints shapes on the context of a canvas. */
export function paint(context, shapes) {
  for (const shape of shapes) {
    context.save();
    context.globalAlpha = shape.alpha ?? 1;
    if (shape.clip) {
      context.beginPath();
      context.rect(...shape.clip);
      context.clip();
    }
    if (shape.text !== undefined) paintText(context, shape);
    else paintPath(context, shape);
    context.restore();
  }
}

function paintPath(context, shape) {
  context.beginPath();
  if (shape.circle) {
    const [x, y, radius] = shape.circle;
    context.arc(x, y, radius, 0, 2 * Math.PI);
  } else {
    shape.points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
    if (shape.closed) context.closePath();
  }
  if (shape.fill) {
    context.fillStyle = fillOf(context, shape.fill);
    context.fill();
  }
  if (shape.stroke) {
    context.strokeStyle = shape.stroke;
    context.lineWidth = shape.width ?? 1;
    context.lineJoin = "round";
    context.lineCap = shape.cap ?? "round";
    context.setLineDash(shape.dash ?? []);
    context.stroke();
  }
}

function fillOf(context, fill) {
  if (!fill.from) return fill;
  const gradient = context.createLinearGradient(0, fill.y0, 0, fill.y1);
  gradient.addColorStop(0, fill.from);
  gradient.addColorStop(1, fill.to);
  return gradient;
}

const SANS = 'system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif';
const SERIF = '"STIX Two Text", "Cambria", "Georgia", "DejaVu Serif", serif';

function paintText(context, shape) {
  context.font = `${shape.italic ? "italic " : ""}${shape.size}px ${shape.italic ? SERIF : SANS}`;
  context.textAlign = shape.align ?? "left";
  context.textBaseline = "alphabetic";
  if (shape.halo) {
    context.strokeStyle = shape.halo;
    context.lineWidth = 4;
    context.lineJoin = "round";
    context.strokeText(shape.text, ...shape.at);
  }
  context.fillStyle = shape.fill;
  context.fillText(shape.text, ...shape.at);
}

/** The largest length of one digit, 1, 2 or 5, that is shorter than this, for a scale bar. */
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  const digit = [5, 2, 1].find((one) => one * power < most);
  return Number((digit ? digit * power : power / 2).toPrecision(1));
}

const ANCHORS = { left: "start", center: "middle", right: "end" };
const escape = (text) => text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
const short = (value) => String(Math.round(value * 100) / 100);

/** The same shapes as an SVG file. */
export function svg(shapes, width, height, title) {
  const defs = [];
  const parts = shapes.map((shape) => element(shape, defs));
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" role="img" width="${width}" height="${height}" ` +
      `viewBox="0 0 ${width} ${height}">`,
    `<title>${escape(title)}</title>`,
    defs.length ? `<defs>${defs.join("")}</defs>` : "",
    ...parts,
    "</svg>\n",
  ].join("\n");
}

function element(shape, defs) {
  const attributes = { opacity: shape.alpha === undefined || shape.alpha === 1 ? undefined : short(shape.alpha) };
  if (shape.clip) {
    const [x, y, width, height] = shape.clip.map(short);
    defs.push(
      `<clipPath id="d${defs.length}"><rect x="${x}" y="${y}" width="${width}" height="${height}"/></clipPath>`,
    );
    attributes["clip-path"] = `url(#d${defs.length - 1})`;
  }
  if (shape.text !== undefined) {
    const [x, y] = shape.at.map(short);
    Object.assign(attributes, {
      x,
      y,
      fill: shape.fill,
      "font-size": short(shape.size),
      "text-anchor": ANCHORS[shape.align ?? "left"],
      "font-family": shape.italic ? SERIF : SANS,
      "font-style": shape.italic ? "italic" : undefined,
      stroke: shape.halo,
      "stroke-width": shape.halo && 4,
      "stroke-linejoin": shape.halo && "round",
      "paint-order": shape.halo && "stroke",
    });
    return `<text${write(attributes)}>${escape(shape.text)}</text>`;
  }
  Object.assign(attributes, {
    fill: shape.fill ? svgFill(shape.fill, defs) : "none",
    stroke: shape.stroke,
    "stroke-width": shape.stroke && short(shape.width ?? 1),
    "stroke-dasharray": shape.dash?.length ? shape.dash.join(" ") : undefined,
    "stroke-linejoin": shape.stroke && "round",
    "stroke-linecap": shape.stroke && (shape.cap ?? "round"),
  });
  if (shape.circle) {
    const [cx, cy, r] = shape.circle.map(short);
    return `<circle${write({ cx, cy, r, ...attributes })}/>`;
  }
  const d =
    shape.points.map(([x, y], i) => `${i ? "L" : "M"}${short(x)} ${short(y)}`).join("") + (shape.closed ? "Z" : "");
  return `<path${write({ d, ...attributes })}/>`;
}

function svgFill(fill, defs) {
  if (!fill.from) return fill;
  const stops = `<stop stop-color="${fill.from}"/><stop offset="1" stop-color="${fill.to}"/>`;
  const place = `gradientUnits="userSpaceOnUse" x1="0" x2="0" y1="${short(fill.y0)}" y2="${short(fill.y1)}"`;
  defs.push(`<linearGradient id="d${defs.length}" ${place}>${stops}</linearGradient>`);
  return `url(#d${defs.length - 1})`;
}

function write(attributes) {
  const kept = Object.entries(attributes).filter(([, value]) => value !== undefined && value !== false);
  return kept.map(([name, value]) => ` ${name}="${typeof value === "string" ? escape(value) : value}"`).join("");
}

/** An arrow from one point to another as shapes; nothing if it would be shorter than a dot. */
export function arrow(from, to, colour, width, rest = {}) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (length < 1.5) return [];
  const head = Math.min(length, 4 + 2.4 * width);
  const [ux, uy] = [dx / length, dy / length];
  const base = [to[0] - ux * head, to[1] - uy * head];
  const half = 0.42 * head;
  const tip = [to, [base[0] - uy * half, base[1] + ux * half], [base[0] + uy * half, base[1] - ux * half]];
  return [
    { points: [from, base], stroke: colour, width, cap: "butt", ...rest },
    { points: tip, closed: true, fill: colour, ...rest },
  ];
}
