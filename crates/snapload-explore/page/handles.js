// Handles on the scene: drag and release the body, move anchors and fairleads, scale the wave's ellipse, zoom in.

import { ellipsePlace, turned } from "./scene.js";

/** The distance within which a pointer grabs a handle [px]. */
const REACH = { fairlead: 9, anchor: 14, ellipse: 10, body: 16 };
/** A start keeps this distance from its cables' ends, so that it stays legal when a field rounds it [L]. */
const CLEAR = 3e-4;
const ROUNDS = 40;
const MOST_ZOOM = 200;
const LEAST_A = 0.01;

const rounded = (value, decimals) => Number(value.toFixed(decimals));

/** The position nearest to a given one at which a body with this rotation is within reach of its lines. */
export function withinReach(lines, [x, y], theta, clear) {
  for (let i = 0; i < ROUNDS; i += 1) {
    for (const { anchor, arm, length } of lines) {
      const [px, py] = turned(arm, { x, y, theta });
      const [dx, dy] = [px - anchor[0], py - anchor[1]];
      const over = Math.hypot(dx, dy) - (length - clear);
      if (over <= 0) continue;
      x -= (over * dx) / Math.hypot(dx, dy);
      y -= (over * dy) / Math.hypot(dx, dy);
    }
  }
  return [x, y];
}

export class Handles {
  /**
   * On the canvas of a view of the scene. `onChange({ settled })` follows a change of values, `onRelease` the release
   * of the body.
   */
  constructor(sceneView, state, { onChange, onRelease }) {
    this.sceneView = sceneView;
    this.state = state;
    this.onChange = onChange;
    this.onRelease = onRelease;
    this.held = null;
    this.pan = null;
    this.pointers = new Map();
    const { canvas } = sceneView;
    canvas.addEventListener("pointerdown", (event) => this.#press(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.#release(event));
    canvas.addEventListener("dblclick", () => state.set({ zoom: null }));
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    // A touch on a handle moves the handle, and does not scroll the page.
    const keep = (event) => (event.touches.length > 1 || this.held) && event.preventDefault();
    for (const name of ["touchstart", "touchmove"]) canvas.addEventListener(name, keep, { passive: false });
  }

  /**
   * The handle at a position of the canvas; null if there is none.
   * @returns {string | null}
   */
  handleAt(px) {
    const { run, moment, cam, size } = this.sceneView.view();
    const near = (point, reach) => Math.hypot(point[0] - px[0], point[1] - px[1]) <= reach;
    const { cables } = run.geometry;
    const rigid = run.geometry.body.kind === "rigid";
    if (rigid && cables.some((cable) => near(cam.place(turned(cable.arm, moment)), REACH.fairlead))) return "fairlead";
    if (cables.some((cable) => near(cam.place(cable.anchor), REACH.anchor))) return "anchor";
    const { a, b } = run.geometry.body;
    if (near(cam.place([moment.x, moment.y]), Math.max(Math.hypot(a, b) * cam.scale, REACH.body))) return "body";
    const { centre, unit } = ellipsePlace(run, moment, cam, size);
    const { f_o, nu } = run.values;
    const [across, up] = [unit * Math.abs(f_o), unit * Math.abs(nu * f_o)];
    const inside = Math.abs(px[0] - centre[0]) <= across + REACH.ellipse && Math.abs(px[1] - centre[1]) <= up + REACH.ellipse;
    return inside ? "ellipse" : null;
  }

  #press(event) {
    if (event.button !== 0 || !this.sceneView.run) return;
    const px = [event.offsetX, event.offsetY];
    this.pointers.set(event.pointerId, px);
    if (this.pointers.size > 1) return this.#beginPinch();
    const what = this.handleAt(px);
    const view = this.sceneView.view();
    if (what) {
      const centre = view.cam.place([view.moment.x, view.moment.y]);
      this.held = { what, view, offset: [px[0] - centre[0], px[1] - centre[1]], moved: false };
      this.sceneView.fixCamera(view.cam);
    } else if (this.state.zoom) this.pan = { px, zoom: this.state.zoom, view };
    if (what || this.pan) this.sceneView.canvas.setPointerCapture(event.pointerId);
  }

  #move(event) {
    if (!this.sceneView.run) return;
    const px = [event.offsetX, event.offsetY];
    if (this.pointers.has(event.pointerId)) this.pointers.set(event.pointerId, px);
    if (this.pinch) return this.#pinch();
    if (this.held) {
      this.held.moved = true;
      return this.drag(px);
    }
    if (this.pan) {
      const { cam } = this.pan.view;
      const [from, to] = [cam.unplace(this.pan.px), cam.unplace(px)];
      const [k, x, y] = this.pan.zoom;
      return this.state.set({ zoom: [k, rounded(x + from[0] - to[0], 5), rounded(y + from[1] - to[1], 5)] });
    }
    this.sceneView.canvas.style.cursor = this.handleAt(px) ? "grab" : this.state.zoom ? "move" : "";
  }

  #release(event) {
    this.pointers.delete(event.pointerId);
    if (this.pointers.size < 2) this.pinch = null;
    const { held } = this;
    this.pan = null;
    this.held = null;
    this.sceneView.fixCamera(null);
    if (!held?.moved) return;
    this.onChange({ since: event.timeStamp, settled: true });
    if (held.what.startsWith("body") && event.type === "pointerup") this.onRelease();
  }

  /** The values with which the grabbed handle is under the pointer. */
  drag(px) {
    const { what, view, offset } = this.held;
    const { run, moment, cam, size } = view;
    const centred = what === "body" ? [px[0] - offset[0], px[1] - offset[1]] : px;
    const [x, y] = cam.unplace(centred);
    const values = {
      body: () => this.#start(run, moment, [x, y]),
      anchor: () => ({ r: rounded(Math.hypot(1 - run.values.a, y - run.values.b), 3) }),
      fairlead: () => this.#arms(run, moment, [x, y]),
      ellipse: () => {
        const { centre, unit } = ellipsePlace(run, moment, cam, size);
        const f_o = rounded(Math.abs(px[0] - centre[0]) / unit, 3);
        const up = Math.abs(px[1] - centre[1]) / unit;
        return f_o > 0 ? { f_o, nu: rounded(up / f_o, 3) } : { f_o };
      },
    }[what]();
    this.state.setValues(values, what === "body" ? { t: 0, window: null } : {});
    this.onChange({ since: performance.now(), settled: false });
  }

  /** A start at rest with the body's rotation, as near to a position as the cables allow. */
  #start(run, { theta }, place) {
    const rigid = run.geometry.body.kind === "rigid";
    const [x, y] = withinReach(run.geometry.cables, place, theta, CLEAR);
    const start = { x: rounded(x, 4), y: rounded(y, 4), vx: 0, vy: 0 };
    return rigid ? { ...start, theta: rounded(theta, 4), vtheta: 0 } : start;
  }

  /** The half-width, and of a box the half-height, with which a fairlead is at a position. */
  #arms(run, moment, [x, y]) {
    const [c, s] = [Math.cos(moment.theta), Math.sin(moment.theta)];
    const [dx, dy] = [x - moment.x, y - moment.y];
    const a = rounded(Math.max(Math.abs(c * dx + s * dy), LEAST_A), 3);
    return run.geometry.body.b > 0 ? { a, b: rounded(Math.max(c * dy - s * dx, LEAST_A), 3) } : { a };
  }

  #wheel(event) {
    // Plain scrolling still scrolls the page; a pinch on a touchpad arrives with ctrl.
    if (!event.ctrlKey || !this.sceneView.run) return;
    event.preventDefault();
    this.#zoom(Math.exp(-event.deltaY / 250), [event.offsetX, event.offsetY]);
  }

  #beginPinch() {
    this.held = this.pan = null;
    this.sceneView.fixCamera(null);
    this.pinch = { before: this.#spread() };
  }

  #pinch() {
    const now = this.#spread();
    this.#zoom(now.distance / this.pinch.before.distance, now.middle);
    this.pinch.before = now;
  }

  #spread() {
    const [one, two] = [...this.pointers.values()];
    return {
      distance: Math.max(Math.hypot(one[0] - two[0], one[1] - two[1]), 1),
      middle: [(one[0] + two[0]) / 2, (one[1] + two[1]) / 2],
    };
  }

  /** Zooms by a factor about a position of the canvas. */
  #zoom(factor, px) {
    const { cam, whole, size } = this.sceneView.view();
    const k = Math.min((cam.scale / whole) * factor, MOST_ZOOM);
    if (k <= 1) return this.state.set({ zoom: null });
    const [x, y] = cam.unplace(px);
    const away = [(px[0] - size.width / 2) / (whole * k), (cam.up * (px[1] - size.height / 2)) / (whole * k)];
    this.state.set({ zoom: [k, x - away[0], y - away[1]].map((value) => Number(value.toPrecision(6))) });
  }
}
