import type { LiveSource } from "../model";
import type { Inspectable, NodeInfo, PropertyInfo, TreeAnswer } from "./inspectable";

/// Inspects the running host.
export class Host implements Inspectable {
  readonly first = "/usr/scene";

  constructor(private readonly live: LiveSource) {}

  get ready(): boolean {
    return this.live.connected;
  }

  get editable(): boolean {
    return this.live.referee;
  }

  async tree(path: string, depth: number): Promise<TreeAnswer> {
    return (await this.live.ask<{ tree: TreeAnswer }>({ do: "tree", path, depth })).tree;
  }

  node(path: string): Promise<NodeInfo> {
    return this.live.ask<NodeInfo>({ do: "get", path });
  }

  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void {
    return this.live.watch(path, property, heard, failed);
  }

  async set(path: string, property: string, text: string): Promise<PropertyInfo> {
    const answer = await this.live.ask<NodeInfo>({ do: "set", path, property, value: text });
    const changed = answer.properties.find((p) => p.name === property);
    if (!changed) throw new Error(`The host changed ${property} and then did not tell its value.`);
    return changed;
  }

  update(): void {}
}
