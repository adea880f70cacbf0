/// The source that the panels inspect: the running host or a recording, with the same interface.

/// A node and, as far as requested, its children. `more`: number of omitted children.
export interface TreeAnswer {
  name: string;
  class: string;
  doc: string;
  children?: TreeAnswer[];
  more?: number;
}

export interface PropertyInfo {
  name: string;
  value: unknown;
  /// The value as people type it.
  text: string;
  /// "number", "vec3", "list of string"...
  type: string;
  unit: string;
  doc: string;
  readOnly?: boolean;
  min?: number;
  max?: number;
  choices?: string[];
}

export interface NodeInfo {
  class: string;
  properties: PropertyInfo[];
}

export interface Inspectable {
  /// False while requests cannot be answered.
  readonly ready: boolean;
  /// The node that is selected first, with its ancestors expanded.
  readonly first: string;
  tree(path: string, depth: number): Promise<TreeAnswer>;
  node(path: string): Promise<NodeInfo>;
  /// Calls back with the current value and after every change, until the returned function is called. Time in simulated
  /// seconds.
  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void;
  /// Rejects with the reason. Only where `editable`.
  set(path: string, property: string, text: string): Promise<PropertyInfo>;
  readonly editable: boolean;
  /// Notifies watchers of changes since the last call; needed if the source does not do so itself.
  update(): void;
}
