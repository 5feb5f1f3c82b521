// The shape of a line of given length between two points of the picture, whose y grows downwards. The model's lines
// have no weight; a slack one is drawn as a parabola of exactly the line's length.

/** Length of the parabola whose slope grows from 0 to m, for a unit step of slope: the integral of sqrt(1 + m²). */
const arc = (m) => 0.5 * (m * Math.hypot(1, m) + Math.asinh(m));

const PIECES = 40;

/** Points from a to b along a line of this length; where it would hang below the floor of a, it lies on it. */
export function slackLine(a, b, length, floor = Infinity) {
  const width = Math.max(Math.abs(b[0] - a[0]), 1e-9);
  const rise = b[1] - a[1];
  if (length <= Math.hypot(width, rise) * (1 + 1e-12)) return [a, b];
  const sag = sagOf(width, rise, length);
  if (a[1] >= floor - 1e-6 && rise < 0 && rise + 4 * sag > 0) return lying(a, b, length);
  return pieces((u) => [a[0] + (b[0] - a[0]) * u, a[1] + rise * u + 4 * sag * u * (1 - u)]);
}

/** The sag s of y = rise u + 4 s u (1 - u), u = 0..1 over the width, that has the length. */
function sagOf(width, rise, length) {
  // Slopes at the ends; between them the slope is linear, so the length is a difference of arcs.
  const lengthOf = (sag) => {
    const [start, end] = [(rise + 4 * sag) / width, (rise - 4 * sag) / width];
    return (width * (arc(start) - arc(end))) / (start - end);
  };
  // A sag of the line's length is more than enough as the upper bound.
  return root((sag) => lengthOf(sag) - length, 1e-9 * length, length);
}

/** A line that lies on the floor from a, and rises to b in a parabola that leaves the floor without a kink. */
function lying(a, b, length) {
  const side = Math.sign(b[0] - a[0]) || 1;
  const reach = Math.abs(b[0] - a[0]);
  const height = a[1] - b[1];
  const rising = (width) => {
    const end = (2 * height) / width;
    return (width / end) * arc(end);
  };
  const least = 1e-6 * height;
  const total = (width) => reach - width + rising(width);
  // The line is longer than reach and height: it is vertical, and the rest lies on the floor, beyond its foot and back.
  const over = Math.max(length - total(least), 0);
  const width = over > 0 ? least : root((w) => length - total(w), least, Math.max(reach, least));
  const lift = b[0] - side * width;
  const curve = pieces((u) => [lift + side * width * u, a[1] - height * u * u]);
  return [a, ...(over > 0 ? [[lift + (side * over) / 2, a[1]]] : []), ...curve];
}

function pieces(point) {
  return Array.from({ length: PIECES + 1 }, (_, k) => point(k / PIECES));
}

/** A root of an increasing function between two bounds, by Newton's method with bisection as a fallback. */
function root(f, low, high) {
  let x = 0.5 * (low + high);
  for (let step = 0; step < 60; step += 1) {
    const value = f(x);
    if (value > 0) high = x;
    else low = x;
    const h = 1e-6 * (high + low);
    const next = x - (value * h) / (f(x + h) - value || 1);
    const inside = next > low && next < high;
    const moved = Math.abs((inside ? next : 0.5 * (low + high)) - x);
    x = inside ? next : 0.5 * (low + high);
    if (moved < 1e-10 * high) break;
  }
  return x;
}
