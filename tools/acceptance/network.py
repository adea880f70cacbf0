"""Other machines in tests: network namespaces of their own, and connections with delay, jitter, stalls and cuts."""
import asyncio
import random
import subprocess
import threading


class Machine:
    """A network namespace, joined to the host by a pair of devices. Needs root."""

    def __init__(self, number):
        self.name, self.inner, self.outer = f"spark-test-{number}", f"10.213.{number}.2", f"10.213.{number}.1"
        self.number = number

    def __enter__(self):
        run = lambda *words: subprocess.run(["ip", *words], check=True)
        here, there = f"spark-o{self.number}", f"spark-i{self.number}"
        self.remove()
        run("netns", "add", self.name)
        run("link", "add", here, "type", "veth", "peer", "name", there)
        run("link", "set", there, "netns", self.name)
        run("addr", "add", f"{self.outer}/24", "dev", here)
        run("link", "set", here, "up")
        run("-n", self.name, "addr", "add", f"{self.inner}/24", "dev", there)
        run("-n", self.name, "link", "set", there, "up")
        run("-n", self.name, "link", "set", "lo", "up")
        return self

    def __exit__(self, *unused):
        self.remove()

    def remove(self):
        for words in (["link", "del", f"spark-o{self.number}"], ["netns", "del", self.name]):
            subprocess.run(["ip", *words], stderr=subprocess.DEVNULL, check=False)

    def start(self, command):
        return subprocess.Popen(["ip", "netns", "exec", self.name, *[str(c) for c in command]])


class Road:
    """Forwards connections to a port of this machine: each byte is late by `delay` +- `jitter` [s], in order. From time to
    time nothing moves for `stall` [s], and after `cut` bytes a connection breaks."""

    def __init__(self, address, port, delay=0.0, jitter=0.0, stall=0.0, cut=None, seed=1):
        self.address, self.target = address, port
        self.delay, self.jitter, self.stall, self.cut = delay, jitter, stall, cut
        self.random = random.Random(seed)
        self.cuts = 0

    def __enter__(self):
        self.loop = asyncio.new_event_loop()
        ready = threading.Event()

        async def listen():
            server = await asyncio.start_server(self.serve, self.address, 0)
            self.port = server.sockets[0].getsockname()[1]
            ready.set()

        def work():
            self.loop.run_until_complete(listen())
            self.loop.run_forever()

        self.thread = threading.Thread(target=work, daemon=True)
        self.thread.start()
        ready.wait()
        return self

    def __exit__(self, *unused):
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()

    async def serve(self, reader, writer):
        there_reader, there_writer = await asyncio.open_connection("127.0.0.1", self.target)
        left = [self.cut] if self.cut else None
        await asyncio.gather(self.carry(reader, there_writer, left), self.carry(there_reader, writer, left), return_exceptions=True)
        for end in (writer, there_writer):
            end.close()

    async def carry(self, reader, writer, left):
        queue = asyncio.Queue()

        async def read():
            arrives = 0.0
            while data := await reader.read(65536):
                now = self.loop.time()
                late = max(0.0, self.delay + self.random.uniform(-self.jitter, self.jitter))
                if self.stall and self.random.random() < 0.001:
                    late += self.stall
                arrives = max(arrives, now + late)
                queue.put_nowait((arrives, data))
            queue.put_nowait((arrives, b""))

        task = asyncio.ensure_future(read())
        try:
            while True:
                at, data = await queue.get()
                await asyncio.sleep(max(0.0, at - self.loop.time()))
                if not data:
                    return
                if left:
                    left[0] -= len(data)
                    if left[0] < 0:
                        self.cuts += 1
                        return
                writer.write(data)
                await writer.drain()
        finally:
            task.cancel()
            writer.close()
