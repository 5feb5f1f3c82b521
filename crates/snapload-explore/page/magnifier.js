// An inset with the path of the centre, magnified, if it fills only a few per cent of the picture.

import { number } from "./formatting.js";

/** A path smaller than this part of the picture is magnified, if that enlarges it by at least this factor. */
const [SMALL, LEAST] = [0.12, 3];
/** The inset: its size as a part of the picture and at most [px], its distance from the edges. */
const INSET = { size: 0.3, most: 190, inset: 12, below: 0.22 };

/** The shapes of the inset next to the cables; `path` makes those of a path with a camera. */
export function magnifier(run, t, cam, { width, height, colours, view, zoom, camera: held }, path) {
  const { x: across, y: up } = run.reach;
  const extent = Math.max(across[1] - across[0], up[1] - up[0]);
  const side = Math.min(width, height);
  if (view === "close" || zoom || held || !(extent > 0) || extent * cam.scale > SMALL * side) return [];
  const size = Math.min(INSET.size * side, INSET.most);
  const scale = (0.8 * size) / extent;
  if (scale < LEAST * cam.scale) return [];
  // Between the surface and the cable of that side.
  const clip = [INSET.inset, cam.up > 0 ? INSET.below * height : (1 - INSET.below) * height - size, size, size];
  const middle = [clip[0] + size / 2, clip[1] + size / 2];
  const [mx, my] = [0.5 * (across[0] + across[1]), 0.5 * (up[0] + up[1])];
  const place = ([px, py]) => [middle[0] + scale * (px - mx), middle[1] + cam.up * scale * (py - my)];
  const inside = (shape) => ({ ...shape, clip });
  const { x: bx, y: by } = run.at(t);
  const style = { stroke: colours.ink, alpha: 0.8, width: 1.1 };
  const corners = [
    [clip[0], clip[1]],
    [clip[0] + size, clip[1]],
    [clip[0] + size, clip[1] + size],
    [clip[0], clip[1] + size],
  ];
  const words = `path of the centre, ${number(scale / cam.scale, 2)} times as large`;
  return [
    { points: corners, closed: true, fill: colours.panel, stroke: colours.faint, width: 1 },
    ...path(run.motion, t, { place }, style, run.horizon.t, colours.past).map(inside),
    { circle: [...place([bx, by]), 3.5], fill: colours.accent, clip },
    { text: words, at: [clip[0] + 2, clip[1] - 5], size: 11, fill: colours.muted },
  ];
}

