import { RepeatWrapping, Texture } from "three";
import { type MeshFile, readMeshFile } from "./mesh_file";

type Reader<T> = (response: Response) => Promise<T>;

/// Mesh files and textures of the host. Each is fetched once, when it is first needed, and shared by all that show it.
export class Assets {
  /// Called whenever a file has come that can be shown.
  onload: () => void = () => undefined;
  /// null: it is on its way, or cannot be shown.
  private readonly meshes = new Map<string, MeshFile | null>();
  private readonly textures = new Map<string, Texture | null>();
  private aborted = new AbortController();

  /// The mesh at this path of the host; null: there is none yet.
  mesh(path: string): MeshFile | null {
    return this.get(this.meshes, path, async response => readMeshFile(await response.arrayBuffer()));
  }

  texture(path: string): Texture | null {
    return this.get(this.textures, path, async response => {
      // As OpenGL has it, the first row is the lowest one.
      const picture = await createImageBitmap(await response.blob(), { imageOrientation: "flipY" });
      const texture = new Texture(picture);
      texture.flipY = false;
      texture.wrapS = texture.wrapT = RepeatWrapping;
      texture.needsUpdate = true;
      return texture;
    });
  }

  /// How many can be shown.
  get count(): { meshes: number; textures: number } {
    const known = (all: Map<string, unknown>) => [...all.values()].filter(each => each !== null).length;
    return { meshes: known(this.meshes), textures: known(this.textures) };
  }

  /// Forgets all, for another host.
  clear(): void {
    this.aborted.abort();
    this.aborted = new AbortController();
    for (const mesh of this.meshes.values()) for (const { geometry } of mesh?.parts ?? []) geometry.dispose();
    for (const texture of this.textures.values()) texture?.dispose();
    this.meshes.clear();
    this.textures.clear();
  }

  private get<T>(known: Map<string, T | null>, path: string, read: Reader<T>): T | null {
    const found = known.get(path);
    if (found !== undefined) return found;
    known.set(path, null);
    void this.load(known, path, read);
    return null;
  }

  /// A file that is missing (204) or damaged is not shown; the host's log says why.
  private async load<T>(known: Map<string, T | null>, path: string, read: Reader<T>): Promise<void> {
    const { signal } = this.aborted;
    try {
      const response = await fetch(path, { signal });
      if (response.status !== 200) return;
      const asset = await read(response);
      if (signal.aborted) return;
      known.set(path, asset);
      this.onload();
    } catch {
      // the connection was lost, or the file is damaged: the scene is shown without it
    }
  }
}
