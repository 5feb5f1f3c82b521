// Lines of many points, in as few of them as are seen: each one more takes its time to paint.

/** A line that is no further off than this [px] is drawn as the straight one that it looks like. */
export const SEEN_PX = 0.25;

/** Draws lines as the context of a canvas does, but leaves out points that lie on the way. */
export class SimplifiedLine {
  /** @param {{ moveTo: (x: number, y: number) => void, lineTo: (x: number, y: number) => void }} target */
  constructor(target) {
    this.target = target;
    /** The point that was drawn last, and the latest one. @type {number[] | null} */
    this.from = null;
    /** @type {number[] | null} */
    this.latest = null;
    /**
     * The piece that is not drawn yet: its direction as a vector of length 1, its length [px], and from which to which
     * angle [rad] off that direction it may be drawn so that it passes each skipped point within SEEN_PX.
     */
    this.direction = [0, 0];
    this.distance = 0;
    this.angles = [0, 0];
  }

  moveTo(x, y) {
    this.finish();
    this.from = null;
    if (!Number.isFinite(x + y)) return;
    this.target.moveTo(x, y);
    this.from = [x, y];
  }

  lineTo(x, y) {
    // A point that is none is left out; a line begins with the first that is one.
    if (!Number.isFinite(x + y)) return;
    if (!this.from) return this.moveTo(x, y);
    const [dx, dy] = [x - this.from[0], y - this.from[1]];
    const distance = Math.hypot(dx, dy);
    const wide = Math.asin(Math.min(SEEN_PX / distance, 1));
    if (this.distance === 0) {
      // Whatever is nearer than can be seen has no way yet.
      if (distance > SEEN_PX) {
        Object.assign(this, { direction: [dx / distance, dy / distance], distance, angles: [-wide, wide] });
      }
      this.latest = [x, y];
      return;
    }
    const [ux, uy] = this.direction;
    const angle = Math.atan2(ux * dy - uy * dx, ux * dx + uy * dy);
    const [low, high] = this.angles;
    if (distance < this.distance || angle < low || angle > high) {
      const from = this.latest;
      this.finish();
      this.from = from;
      this.lineTo(x, y);
      return;
    }
    this.distance = distance;
    this.angles = [Math.max(low, angle - wide), Math.min(high, angle + wide)];
    this.latest = [x, y];
  }

  /** Draws what is left of the line. */
  finish() {
    if (this.latest) this.target.lineTo(this.latest[0], this.latest[1]);
    this.latest = null;
    this.distance = 0;
  }
}
