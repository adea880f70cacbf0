import type { World } from "./model";

export type { World };
