import type { Socket } from "../../src/sources/connection";

/// A host at the other end of a fake WebSocket.
export class FakeHost {
  readonly sockets: FakeSocket[] = [];

  readonly connect = (url: string): Socket => {
    const socket = new FakeSocket(url);
    this.sockets.push(socket);
    return socket;
  };

  get socket(): FakeSocket {
    return this.sockets[this.sockets.length - 1]!;
  }

  accept(): void {
    this.socket.onopen?.(undefined as never);
  }

  say(message: unknown): void {
    this.socket.onmessage?.({ data: typeof message === "string" ? message : JSON.stringify(message) });
  }

  frame(bytes: Uint8Array): void {
    this.socket.onmessage?.({ data: bytes.slice().buffer });
  }

  hangUp(): void {
    this.socket.onclose?.(undefined as never);
  }

  /// The viewer's messages on this connection.
  get heard(): Record<string, unknown>[] {
    return this.socket.sent.map((text) => JSON.parse(text) as Record<string, unknown>);
  }
}

class FakeSocket implements Socket {
  binaryType = "";
  onopen: ((event: never) => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: never) => void) | null = null;
  onerror: ((event: never) => void) | null = null;
  readonly sent: string[] = [];
  closed = false;

  constructor(readonly url: string) {}

  send(data: string): void {
    this.sent.push(data);
  }

  close(): void {
    this.closed = true;
  }
}
