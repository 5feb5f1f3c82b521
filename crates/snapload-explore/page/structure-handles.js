// Handles on a structure: drag and release the body, move anchors and fairleads, in metres.

import { Handles, withinReach } from "./handles.js";
import { turned } from "./scene.js";

/** The distance within which a pointer grabs a handle [px]. */
const REACH = { fairlead: 9, anchor: 14, body: 12 };
/** A start keeps this distance from its lines' ends, so that it stays legal when it is rounded to centimetres. */
const CLEAR_M = 0.015;
const near = (value) => Number(value.toFixed(2));
/** @param {number[]} place */
const pair = ([x, z]) => `[${near(x)}, ${near(z)}]`;

export class StructureHandles extends Handles {
  /** The handle at a position of the canvas, with the number of its line. */
  handleAt(px) {
    const { run, moment, cam } = this.sceneView.view();
    const by = (point, reach) => Math.hypot(point[0] - px[0], point[1] - px[1]) <= reach;
    const { lines, width, height, outline } = run.geometry;
    const fairlead = lines.findIndex(({ arm }) => by(cam.place(turned(arm, moment)), REACH.fairlead));
    if (fairlead >= 0) return `fairlead.${fairlead + 1}`;
    const anchor = lines.findIndex((line) => by(cam.place(line.anchor), REACH.anchor));
    if (anchor >= 0) return `anchor.${anchor + 1}`;
    const size = (outline === "circle" ? width : Math.hypot(width, height)) / 2;
    return by(cam.place([moment.x, moment.y]), Math.max(size * cam.scale, REACH.body)) ? "body" : null;
  }

  /** The values with which the grabbed handle is under the pointer. */
  drag(px) {
    const { what, view, offset } = this.held;
    const { run, moment, cam } = view;
    const [kind, line] = what.split(".");
    const [x, z] = cam.unplace(kind === "body" ? [px[0] - offset[0], px[1] - offset[1]] : px);
    const values = {
      body: () => ({ "run.start": pair(withinReach(run.geometry.lines, [x, z], 0, CLEAR_M)) }),
      anchor: () => ({ [`line.${line}.anchor`]: pair([x, z]) }),
      fairlead: () => ({ [`line.${line}.fairlead`]: pair(this.#fairlead(run, moment, [x, z])) }),
    }[kind]();
    this.state.setValues(values, kind === "body" ? { t: 0, window: null } : {});
    this.onChange({ since: performance.now(), settled: false });
  }

  /**
   * A point on the body at its position in the case, without rotation.
   * @returns {[number, number]}
   */
  #fairlead(run, moment, [x, z]) {
    const [c, s] = [Math.cos(moment.theta), Math.sin(moment.theta)];
    const [dx, dz] = [x - moment.x, z - moment.y];
    const [px, pz] = run.geometry.position;
    return [px + c * dx + s * dz, pz - s * dx + c * dz];
  }
}
