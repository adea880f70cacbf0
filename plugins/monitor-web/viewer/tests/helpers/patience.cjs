// vitest's processes give each other 60 s for an answer, which cannot be set: on a slow machine that is not enough for a file that is busy.
const kGivesUp = 60_000, kPatience = 3_600_000;
const plain = globalThis.setTimeout;
const patient = (call, wait, ...rest) => plain(call, wait === kGivesUp ? kPatience : wait, ...rest);
globalThis.setTimeout = Object.defineProperties(patient, Object.getOwnPropertyDescriptors(plain));
