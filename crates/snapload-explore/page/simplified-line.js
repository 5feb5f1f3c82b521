// Lines of many points, reduced to those that are visible, so that they are painted faster.

/** Points that are closer than this to a straight line [px] are left out. */
export const SEEN_PX = 0.25;

/** Draws lines like the context of a canvas, but leaves out points that lie on a straight line. */
export class SimplifiedLine {
  /** @param {{ moveTo: (x: number, y: number) => void, lineTo: (x: number, y: number) => void }} target */
  constructor(target) {
    this.target = target;
    /** The last point that was drawn, and the latest one. @type {number[] | null} */
    this.from = null;
    /** @type {number[] | null} */
    this.latest = null;
    /**
     * The piece that is not drawn yet: its direction as a unit vector, its length [px], and the range of angles [rad]
     * from that direction in which it passes each skipped point within SEEN_PX.
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
    // Points that are not finite are left out; a line starts with the first finite one.
    if (!Number.isFinite(x + y)) return;
    if (!this.from) return this.moveTo(x, y);
    const [dx, dy] = [x - this.from[0], y - this.from[1]];
    const distance = Math.hypot(dx, dy);
    const wide = Math.asin(Math.min(SEEN_PX / distance, 1));
    if (this.distance === 0) {
      // A point too close to be visible gives no direction yet.
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

  /** Draws the rest of the line. */
  finish() {
    if (this.latest) this.target.lineTo(this.latest[0], this.latest[1]);
    this.latest = null;
    this.distance = 0;
  }
}
