"""Pieces of recorded inputs (plugins/recorder/input_codec.h), whose bits a range coder packs."""


class Chance:
    """How probable it is that a bit is set."""

    def __init__(self):
        self.estimate, self.count = 0x8000, 0

    def update(self, bit):
        change = 2 * ((0xFFFF if bit else 0) - self.estimate)
        self.estimate += int(change / (2 * self.count + 3))  # rounds towards zero
        self.count = min(self.count + 1, 100)


class RangeWriter:
    def __init__(self):
        self.low, self.high, self.out = 0, 0xFFFFFFFF, bytearray()

    def bit(self, chance, bit):
        middle = self.low + ((self.high - self.low) * (chance.estimate | 1) >> 16)
        if bit:
            self.high = middle
        else:
            self.low = middle + 1
        while (self.low ^ self.high) >> 24 == 0:
            self.out.append(self.high >> 24)
            self.low, self.high = self.low << 8 & 0xFFFFFFFF, (self.high << 8 | 0xFF) & 0xFFFFFFFF
        chance.update(bit)

    def symbol(self, chances, bits, value):
        node = 1
        for i in reversed(range(bits)):
            bit = value >> i & 1
            self.bit(chances.setdefault(node, Chance()), bit)
            node = node << 1 | bit

    def finish(self):
        last = mask = 0
        while last < self.low:
            mask = mask >> 8 | 0xFF000000
            last = self.high & mask
        while last:
            self.out.append(last >> 24)
            last = last << 8 & 0xFFFFFFFF
        return bytes(self.out)


def piece_of_times(count):
    """The first piece after a restart: that many inputs that say that the wall clock reads 0."""
    time, end = 1, 8
    coder, kinds, lengths = RangeWriter(), {}, {}
    last = end
    for _ in range(count):
        coder.symbol(kinds.setdefault(last, {}), 4, time)
        coder.symbol(lengths, 7, 0)
        last = time
    coder.symbol(kinds.setdefault(last, {}), 4, end)
    return b"\0" + coder.finish()
