/// What the panels look into: the running host, or a recording. Both answer the same questions.

/// A node and, as far as they were asked for, its children; `more` counts those that were left out.
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
  /// False while there would be no answer.
  readonly ready: boolean;
  /// The node that is shown first, opened with all above it.
  readonly first: string;
  tree(path: string, depth: number): Promise<TreeAnswer>;
  node(path: string): Promise<NodeInfo>;
  /// Hears the value now and after every change, until the returned function is called. Time in simulated seconds.
  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void;
  /// Rejects with the reason. Only where `editable`.
  set(path: string, property: string, text: string): Promise<PropertyInfo>;
  readonly editable: boolean;
  /// Notifies watchers of changes since the last call; needed if the source does not do so itself.
  update(): void;
}
