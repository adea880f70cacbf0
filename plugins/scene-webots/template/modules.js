// What templates in Javascript find: fields, context, the modules wb*, console; random numbers and times that are the
// same in each run. The value of this file is a function that makes a program of a template's text.
(function () {
  const request = JSON.parse(spark$request(), (key, value) => (value === null ? undefined : value));  // as NULL is
  const say = (...what) => spark$say(what.map(String).join(' '));
  globalThis.fields = request.fields;
  globalThis.context = request.context;
  globalThis.console = {log: say, info: say, warn: say, debug: say, error: say};

  const copy = (rotation) => Object.assign({}, rotation);
  const vector = (keys) => {
    const each = (f) => (a, b) => Object.fromEntries(keys.map((k) => [k, f(a[k], b && b[k])]));
    const sum = (f) => (a, b) => keys.reduce((s, k) => s + f(a[k], b[k]), 0);
    const add = each((a, b) => a + b), minus = each((a, b) => a - b), dot = sum((a, b) => a * b);
    const multiply = (v, s) => each((a) => a * s)(v);
    const norm = (v) => Math.sqrt(dot(v, v));
    return {
      add, minus, dot, multiply, norm,
      equal: (a, b) => keys.every((k) => a[k] === b[k]),
      distance: (a, b) => norm(minus(a, b)),
      normalize: (v) => multiply(v, 1 / norm(v)),
    };
  };
  const wbvector2 = vector(['x', 'y']);
  wbvector2.cross = (a, b) => a.x * b.y - a.y * b.x;
  wbvector2.angle = (a, b) => Math.atan2(a.y - b.y, a.x - b.x);
  wbvector2.intersection = (p1, p2, p3, p4) => {
    const r = wbvector2.minus(p2, p1), s = wbvector2.minus(p4, p3), between = wbvector2.minus(p3, p1);
    const parallel = wbvector2.cross(r, s);
    if (parallel === 0) return null;
    const t = wbvector2.cross(between, s) / parallel, u = wbvector2.cross(between, r) / parallel;
    return t >= 0 && t <= 1 && u >= 0 && u <= 1 ? wbvector2.add(p1, wbvector2.multiply(r, t)) : null;
  };
  const wbvector3 = vector(['x', 'y', 'z']);
  wbvector3.cross = (a, b) => ({x: a.y * b.z - a.z * b.y, y: a.z * b.x - a.x * b.z, z: a.x * b.y - a.y * b.x});

  // The numbers of Webots: x' = (1140671485 x + 12820163) mod 2^24.
  const kModulus = 2 ** 24;
  let random = 0;
  const next = () => (random = (1140671485 * random + 12820163) % kModulus);
  const range = (min, max, most) => (min === undefined ? [0, most] : max === undefined ? [0, min] : [min, max]);
  const wbrandom = {
    seed: (s) => { random = s; },
    real: (min, max) => {
      const [a, b] = range(min, max, 1);
      return a + next() * (b - a) / (kModulus - 1);
    },
    integer: (min, max) => {
      const [a, b] = range(min, max, kModulus - 1);
      return a + next() % (1 + b - a);
    },
  };
  Math.random = () => next() / kModulus;

  const identity = () => ({x: 0, y: 1, z: 0, a: 0});
  const wbrotation = {
    equal: (a, b) => ['x', 'y', 'z', 'a'].every((k) => a[k] === b[k]),
    isValid: (r) => r.x !== 0 || r.y !== 0 || r.z !== 0,
    isIdentity: (r) => r.a === 0,
    normalizeAxis: (r) => {
      const n = wbvector3.norm(r);
      return n > 0 ? {x: r.x / n, y: r.y / n, z: r.z / n, a: r.a} : {x: 0, y: 1, z: 0, a: r.a};
    },
    normalizeAngle: (r) => Object.assign(copy(r), {a: r.a - 2 * Math.PI * Math.round(r.a / (2 * Math.PI))}),
    normalize: (r) => wbrotation.normalizeAngle(wbrotation.normalizeAxis(r)),
    fromQuaternion: (q) => {
      const n = wbvector3.norm(q);
      if (n < 1e-10) return identity();
      return {x: q.x / n, y: q.y / n, z: q.z / n, a: 2 * Math.atan2(n, q.w)};
    },
    toQuaternion: (rotation) => {
      const r = wbrotation.normalize(rotation), s = Math.sin(r.a / 2);
      return {w: Math.cos(r.a / 2), x: r.x * s, y: r.y * s, z: r.z * s};
    },
    toMatrix3: (rotation) => {
      const r = wbrotation.normalizeAxis(rotation), c = Math.cos(r.a), s = Math.sin(r.a), t = 1 - c;
      return [r.x * r.x * t + c, r.x * r.y * t - r.z * s, r.x * r.z * t + r.y * s,
              r.x * r.y * t + r.z * s, r.y * r.y * t + c, r.y * r.z * t - r.x * s,
              r.x * r.z * t - r.y * s, r.y * r.z * t + r.x * s, r.z * r.z * t + c];
    },
    fromMatrix3: (m) => {
      // Of the four formulas for a quaternion, the one with the largest divisor.
      const squares = [1 + m[0] + m[4] + m[8], 1 + m[0] - m[4] - m[8], 1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8]];
      const i = squares.indexOf(Math.max(...squares)), n = Math.sqrt(squares[i]);
      const a = m[7] - m[5], b = m[2] - m[6], c = m[3] - m[1], d = m[1] + m[3], e = m[2] + m[6], f = m[5] + m[7];
      const q = [[n * n, a, b, c], [a, n * n, d, e], [b, d, n * n, f], [c, e, f, n * n]][i].map((v) => v / (2 * n));
      return wbrotation.normalize(wbrotation.fromQuaternion({w: q[0], x: q[1], y: q[2], z: q[3]}));
    },
    combine: (rA, rB) => {
      const a = wbrotation.toQuaternion(rA), b = wbrotation.toQuaternion(rB);
      return wbrotation.normalizeAngle(wbrotation.fromQuaternion({
        w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
      }));
    },
    rotateVector3ByMatrix3: (m, v) => ({
      x: m[0] * v.x + m[1] * v.y + m[2] * v.z,
      y: m[3] * v.x + m[4] * v.y + m[5] * v.z,
      z: m[6] * v.x + m[7] * v.y + m[8] * v.z,
    }),
    rotateVector3ByRotation: (r, v) => wbrotation.rotateVector3ByMatrix3(wbrotation.toMatrix3(r), v),
    rotateVector3ByQuaternion: (q, v) => wbrotation.rotateVector3ByRotation(wbrotation.fromQuaternion(q), v),
  };

  // Uniform cubic B-spline through control points that are extended by two at each end.
  const spline = (space, first) => (given, subdivision) => {
    const beyond = (a, b) => space.add(a, space.minus(a, b));
    const head = beyond(given[0], given[1]), tail = beyond(given[given.length - 1], given[given.length - 2]);
    const points = [beyond(head, given[0]), head, ...given, tail, beyond(tail, given[given.length - 1])];
    const out = [given[0]];
    for (let i = 1 + first; i + 3 < points.length; ++i)
      for (let j = 1; j <= subdivision; ++j) {
        const t = j / subdivision, u = 1 - t;
        const weights = [u ** 3, 3 * t ** 3 - 6 * t ** 2 + 4, -3 * t ** 3 + 3 * t ** 2 + 3 * t + 1, t ** 3];
        out.push(weights.map((w, k) => space.multiply(points[i - 1 + k], w / 6)).reduce(space.add));
      }
    return out;
  };
  const wbgeometry = {
    circle: (radius, div, center, shift) => Array.from({length: div + 1}, (_, i) => {
      const a = 2 * Math.PI * i / div + shift;
      return {x: radius * Math.cos(a) + center.x, y: radius * Math.sin(a) + center.y};
    }),
    isPoint2InPolygon: (p, polygon) => {
      let inside = false;
      polygon.forEach((b, i) => {
        const a = polygon[(i + polygon.length - 1) % polygon.length];
        if ((a.y > p.y) !== (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) inside = !inside;
      });
      return inside;
    },
    findClosestPoint2InArray: (reference, points) => points.reduce(
      (best, p) => wbvector2.distance(reference, p) < wbvector2.distance(reference, best) ? p : best),
    isPoint2ArrayClockwise: (points) => points.reduce((sum, p, i) => {
      const q = points[(i + 1) % points.length];
      return sum + (q.x - p.x) * (q.y + p.y);
    }, 0) < 0,
    bSpline2: spline(wbvector2, 0),
    bSpline3: spline(wbvector3, 1),
  };

  const isNumbers = (v, keys) => v !== null && typeof v === 'object' && Object.keys(v).length === keys.length &&
    keys.every((k) => typeof v[k] === 'number');
  const wbutility = {
    assert: (statement, message) => { if (!statement) say(message); },
    error: say,
    info: say,
    deepCopy: (v) => {
      if (v === null || typeof v !== 'object') return v;
      const parts = Object.entries(v).map(([k, part]) => [k, wbutility.deepCopy(part)]);
      return Object.assign(Array.isArray(v) ? [] : {}, Object.fromEntries(parts));
    },
    degreesToRadians: (a) => a * Math.PI / 180,
    radiansToDegrees: (a) => a * 180 / Math.PI,
    isScalar: (v) => typeof v === 'number',
    isVector2: (v) => isNumbers(v, ['x', 'y']),
    isVector3: (v) => isNumbers(v, ['x', 'y', 'z']),
    isAxisAngle: (v) => isNumbers(v, ['x', 'y', 'z', 'a']),
    isQuaternion: (v) => isNumbers(v, ['w', 'x', 'y', 'z']),
    isMatrix3: (v) => isNumbers(v, ['0', '1', '2', '3', '4', '5', '6', '7', '8']),
    isArrayOfPoints: (points, dim) => Array.isArray(points) &&
      points.every((p) => dim === 2 ? wbutility.isVector2(p) : wbutility.isVector3(p)),
  };
  const noFile = (name) => { throw new Error(`templates read and write no files: '${name}'`); };
  globalThis.wbfile = {fileExists: () => false, readTextFile: noFile, writeTextFile: noFile};
  const modules = {wbrandom, wbrotation, wbvector2, wbvector3, wbgeometry, wbutility};
  globalThis.spark$module = (file) => {
    const name = file.replace(/^.*\//, '').replace(/\.m?js$/, '');
    if (!Object.hasOwn(modules, name)) throw new Error(`there is no module '${file}'`);
    return modules[name];
  };

  // Each run has the same time.
  const Clock = Date;
  globalThis.Date = class Date extends Clock {
    constructor(...a) { if (a.length) super(...a); else super(0); }
    static now() { return 0; }
  };

  // `import` stands at the top of a module; here it becomes a variable of the program, in its first line.
  return function (text) {
    const imports = new Set();
    const take = (names) => (all, list, quote, file) => {
      imports.add(`var ${names(list)} = spark$module(${JSON.stringify(file)});`);
      return all.replace(/[^\n]/g, ' ');
    };
    const body = text
      .replace(/\bimport\s*\*\s*as\s+([\w$]+)\s+from\s*(['"])(.*?)\2[ \t]*;?/g, take((name) => name))
      .replace(/\bimport\s*\{([^}]*)\}\s*from\s*(['"])(.*?)\2[ \t]*;?/g,
               take((list) => `{${list.replace(/\bas\b/g, ':')}}`));
    return `(function () { var spark$value; ${[...imports].join(' ')} ${body}\n})()`;
  };
})()
