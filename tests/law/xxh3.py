"""XXH3-64, after the xxHash specification (github.com/Cyan4973/xxHash, doc/xxhash_spec.md)."""

from struct import unpack_from

M64 = (1 << 64) - 1
P32_1, P32_2, P32_3 = 0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D
P64_1, P64_2, P64_3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9
P64_4, P64_5 = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
PMX1, PMX2 = 0x165667919E3779F9, 0x9FB21C651E98DF25
SECRET = bytes.fromhex(
    "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671f"
    "cb79e64eccc0e578825ad07dccff7221b8084674f743248ee03590e6813a264c"
    "3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8"
    "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364"
    "eac5ac8334d3ebc3c581a0fffa1363eb170ddd51b7f0da49d316552629d4689e"
    "2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e"
)


def u64(data, at):
    return unpack_from("<Q", data, at)[0]


def u32(data, at):
    return unpack_from("<I", data, at)[0]


def fold(a, b):
    product = a * b
    return (product ^ product >> 64) & M64


def avalanche(x):
    x = (x ^ x >> 37) * PMX1 & M64
    return x ^ x >> 32


def avalanche64(x):
    x = (x ^ x >> 33) * P64_2 & M64
    x = (x ^ x >> 29) * P64_3 & M64
    return x ^ x >> 32


def mix(data, at, place, seed):
    """16 bytes of the data with 16 of the secret."""
    low = u64(data, at) ^ (u64(SECRET, place) + seed & M64)
    high = u64(data, at + 8) ^ (u64(SECRET, place + 8) - seed & M64)
    return fold(low, high)


def short(data, seed):
    """Up to 16 bytes."""
    n = len(data)
    if n > 8:
        low = (u64(SECRET, 24) ^ u64(SECRET, 32)) + seed & M64 ^ u64(data, 0)
        high = (u64(SECRET, 40) ^ u64(SECRET, 48)) - seed & M64 ^ u64(data, n - 8)
        swapped = int.from_bytes(low.to_bytes(8, "little"), "big")
        return avalanche(n + swapped + high + fold(low, high) & M64)
    if n > 3:
        low32 = seed & 0xFFFFFFFF
        seed ^= int.from_bytes(low32.to_bytes(4, "little"), "big") << 32
        x = u32(data, n - 4) | u32(data, 0) << 32
        x ^= (u64(SECRET, 8) ^ u64(SECRET, 16)) - seed & M64
        x ^= (x << 49 | x >> 15) & M64 ^ (x << 24 | x >> 40) & M64
        x = x * PMX2 & M64
        x ^= (x >> 35) + n
        x = x * PMX2 & M64
        return x ^ x >> 28
    if n > 0:
        x = data[n - 1] | n << 8 | data[0] << 16 | data[n >> 1] << 24
        return avalanche64((u32(SECRET, 0) ^ u32(SECRET, 4)) + seed & M64 ^ x)
    return avalanche64(seed ^ u64(SECRET, 56) ^ u64(SECRET, 64))


def middle(data, seed):
    """17 to 240 bytes."""
    n = len(data)
    sum_ = n * P64_1
    if n <= 128:
        for i in range((n - 1) // 32, -1, -1):
            sum_ += mix(data, 16 * i, 32 * i, seed) + mix(data, n - 16 * (i + 1), 32 * i + 16, seed)
        return avalanche(sum_ & M64)
    for i in range(8):
        sum_ += mix(data, 16 * i, 16 * i, seed)
    sum_ = avalanche(sum_ & M64)
    for i in range(8, n // 16):
        sum_ += mix(data, 16 * i, 16 * (i - 8) + 3, seed)
    return avalanche(sum_ + mix(data, n - 16, 136 - 17, seed) & M64)


def accumulate(sums, stripe, secret):
    for i in range(8):
        value = stripe[i] ^ secret[i]
        sums[i ^ 1] = sums[i ^ 1] + stripe[i] & M64
        sums[i] = sums[i] + (value & 0xFFFFFFFF) * (value >> 32) & M64


def long(data, seed):
    """More than 240 bytes."""
    secret = SECRET
    if seed:
        words = unpack_from("<24Q", SECRET)
        secret = b"".join((w + (-seed if i & 1 else seed) & M64).to_bytes(8, "little") for i, w in enumerate(words))
    sums = [P32_3, P64_1, P64_2, P64_3, P64_4, P32_2, P64_5, P32_1]
    n, end = len(data), unpack_from("<8Q", secret, 128)
    keys = [unpack_from("<8Q", secret, 8 * i) for i in range(16)]
    # A block is 16 stripes; the last stripe of the data is taken again with a place of its own in the secret.
    for i in range((n - 1) // 64):
        accumulate(sums, unpack_from("<8Q", data, 64 * i), keys[i % 16])
        if i % 16 == 15:
            sums = [(s ^ s >> 47 ^ k) * P32_1 & M64 for s, k in zip(sums, end)]
    accumulate(sums, unpack_from("<8Q", data, n - 64), unpack_from("<8Q", secret, 192 - 71))
    total = n * P64_1
    for i in range(4):
        total += fold(sums[2 * i] ^ u64(secret, 11 + 16 * i), sums[2 * i + 1] ^ u64(secret, 19 + 16 * i))
    return avalanche(total & M64)


def xxh3(data, seed=0):
    data = bytes(data)
    return short(data, seed) if len(data) <= 16 else middle(data, seed) if len(data) <= 240 else long(data, seed)
