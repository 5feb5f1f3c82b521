// Lines of many points, in as few of them as are seen: each one more takes its time to paint.

/** A line that is no further off than this [px] is drawn as the straight one that it looks like. */
export const SEEN_PX = 0.25;

/** Draws lines as the context of a canvas does, but leaves out points that lie on the way. */
export class Pen {
  /** @param {{ moveTo: (x: number, y: number) => void, lineTo: (x: number, y: number) => void }} paper */
  constructor(paper) {
    this.paper = paper;
    /** The point that was drawn last, and the latest one. @type {number[] | null} */
    this.from = null;
    /** @type {number[] | null} */
    this.latest = null;
    /**
     * The piece that is not drawn yet: its direction as a vector of length 1, its length [px], and from which to which
     * angle [rad] off that direction it may be drawn so that it passes each skipped point within SEEN_PX.
     */
    this.way = [0, 0];
    this.far = 0;
    this.angles = [0, 0];
  }

  moveTo(x, y) {
    this.lift();
    this.from = null;
    if (!Number.isFinite(x + y)) return;
    this.paper.moveTo(x, y);
    this.from = [x, y];
  }

  lineTo(x, y) {
    // A point that is none is left out; a line begins with the first that is one.
    if (!Number.isFinite(x + y)) return;
    if (!this.from) return this.moveTo(x, y);
    const [dx, dy] = [x - this.from[0], y - this.from[1]];
    const far = Math.hypot(dx, dy);
    const wide = Math.asin(Math.min(SEEN_PX / far, 1));
    if (this.far === 0) {
      // Whatever is nearer than can be seen has no way yet.
      if (far > SEEN_PX) Object.assign(this, { way: [dx / far, dy / far], far, angles: [-wide, wide] });
      this.latest = [x, y];
      return;
    }
    const [wx, wy] = this.way;
    const angle = Math.atan2(wx * dy - wy * dx, wx * dx + wy * dy);
    const [low, high] = this.angles;
    if (far < this.far || angle < low || angle > high) {
      const from = this.latest;
      this.lift();
      this.from = from;
      this.lineTo(x, y);
      return;
    }
    this.far = far;
    this.angles = [Math.max(low, angle - wide), Math.min(high, angle + wide)];
    this.latest = [x, y];
  }

  /** Draws what is left of the line. */
  lift() {
    if (this.latest) this.paper.lineTo(this.latest[0], this.latest[1]);
    this.latest = null;
    this.far = 0;
  }
}
