// A WebM file of encoded frames: the elements of Matroska (RFC 9559) that a player needs to show them, to know their
// durations, and to seek.

/** The identifiers of elements in the RFC. */
const ID = {
  header: 0x1a45dfa3,
  headerVersion: 0x4286,
  headerReadVersion: 0x42f7,
  longestId: 0x42f2,
  longestSize: 0x42f3,
  documentType: 0x4282,
  documentVersion: 0x4287,
  documentReadVersion: 0x4285,
  segment: 0x18538067,
  info: 0x1549a966,
  timestampScale: 0x2ad7b1,
  duration: 0x4489,
  muxingApp: 0x4d80,
  writingApp: 0x5741,
  tracks: 0x1654ae6b,
  track: 0xae,
  trackNumber: 0xd7,
  trackUid: 0x73c5,
  trackType: 0x83,
  codec: 0x86,
  frameDuration: 0x23e383,
  video: 0xe0,
  width: 0xb0,
  height: 0xba,
  cues: 0x1c53bb6b,
  cuePoint: 0xbb,
  cueTime: 0xb3,
  cuePositions: 0xb7,
  cueTrack: 0xf7,
  cueCluster: 0xf1,
  cluster: 0x1f43b675,
  clusterTime: 0xe7,
  simpleBlock: 0xa3,
};

const VIDEO = 1;
const NANOSECONDS = 1e6;
const KEY_PICTURE = 0x80;

const join = (parts) => {
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
};

/** An unsigned whole number in as few bytes as it needs, the most significant first. */
function bytesOf(number) {
  const bytes = [];
  for (let rest = number; rest > 0 || bytes.length === 0; rest = Math.floor(rest / 256)) bytes.unshift(rest % 256);
  return new Uint8Array(bytes);
}

/** A length in eight bytes, the first of which says that there are eight. */
function lengthOf(size) {
  const bytes = new Uint8Array(8);
  let rest = size;
  for (let i = 7; i > 0; i -= 1) {
    bytes[i] = rest % 256;
    rest = Math.floor(rest / 256);
  }
  bytes[0] = 0x01;
  return bytes;
}

const element = (id, content) => join([bytesOf(id), lengthOf(content.length), content]);
const whole = (id, number) => element(id, bytesOf(number));
const words = (id, text) => element(id, new TextEncoder().encode(text));
const parent = (id, ...children) => element(id, join(children));

function real(id, number) {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, number);
  return element(id, bytes);
}

/** A position in the file, always in eight bytes, as it is written before it is known. */
function place(id, number) {
  const bytes = lengthOf(number);
  bytes[0] = 0;
  return element(id, bytes);
}

function block({ data, time, key }, clusterTime) {
  const head = new Uint8Array(4);
  head[0] = 0x80 | 1;
  new DataView(head.buffer).setInt16(1, time - clusterTime);
  head[3] = key ? KEY_PICTURE : 0;
  return element(ID.simpleBlock, join([head, data]));
}

/** Frames in clusters that each start with a key frame. */
function clustersOf(pictures) {
  const clusters = [];
  for (const picture of pictures) {
    if (picture.key || clusters.length === 0) clusters.push([]);
    clusters.at(-1).push(picture);
  }
  return clusters.map((group) => ({
    time: group[0].time,
    bytes: parent(ID.cluster, whole(ID.clusterTime, group[0].time), ...group.map((one) => block(one, group[0].time))),
  }));
}

/**
 * The file. `pictures` are { data, time, key }: bytes, milliseconds from the start, and whether it is a key frame. No
 * cluster is longer than half a minute, as a frame's time within it has 16 bits.
 */
export function webm({ codec, width, height, framesASecond, pictures }) {
  const duration = pictures.length * (1000 / framesASecond);
  const header = parent(
    ID.header,
    whole(ID.headerVersion, 1),
    whole(ID.headerReadVersion, 1),
    whole(ID.longestId, 4),
    whole(ID.longestSize, 8),
    words(ID.documentType, "webm"),
    whole(ID.documentVersion, 4),
    whole(ID.documentReadVersion, 2),
  );
  const info = parent(
    ID.info,
    whole(ID.timestampScale, NANOSECONDS),
    real(ID.duration, duration),
    words(ID.muxingApp, "snapload"),
    words(ID.writingApp, "snapload"),
  );
  const tracks = parent(
    ID.tracks,
    parent(
      ID.track,
      whole(ID.trackNumber, 1),
      whole(ID.trackUid, 1),
      whole(ID.trackType, VIDEO),
      words(ID.codec, codec),
      whole(ID.frameDuration, Math.round(1e9 / framesASecond)),
      parent(ID.video, whole(ID.width, width), whole(ID.height, height)),
    ),
  );
  const clusters = clustersOf(pictures);
  // The start of each cluster, from the first byte of the segment's content; the cues come before them and have a fixed
  // length.
  const cuesAt = (first) => {
    let at = first;
    const points = clusters.map(({ time, bytes }) => {
      const point = parent(
        ID.cuePoint,
        whole(ID.cueTime, time),
        parent(ID.cuePositions, whole(ID.cueTrack, 1), place(ID.cueCluster, at)),
      );
      at += bytes.length;
      return point;
    });
    return parent(ID.cues, ...points);
  };
  const before = info.length + tracks.length;
  const cues = cuesAt(before + cuesAt(0).length);
  const segment = parent(ID.segment, info, tracks, cues, ...clusters.map(({ bytes }) => bytes));
  return new Blob([header, segment], { type: "video/webm" });
}
