"""The cache of `train_step/nrc/gate` and `query/nrc/gate` in PyTorch, for scripts/measure/compare-pytorch. Prints one line of JSON.

The same mathematics on a surface of the same size: feature vectors of 8 on the nodes of two levels (R = 2 and 1), 16 direction
inputs, two hidden layers of 32, relative L2, Adam for the network and sparse Adam for the features. The timing excludes
work that PyTorch is not made for: the nodes that a point reads, their weights, and the direction's encoding are computed
beforehand. Only the queries of "query_all" do all the work that ours do. It keeps no averages and rejects no records. It uses
the fastest functions of PyTorch: embedding_bag with sparse gradients, and queries in chunks. Features are updated by
SparseAdam, the usual choice, and by the same formula in tensor operations, which is faster if many nodes are touched."""

import argparse
import json
import math
import statistics
import time

import numpy as np
import torch
from torch.nn import functional

COLUMNS, ROWS = 1000, 500  # quads of the torus; two triangles each
VERTICES, EDGES = COLUMNS * ROWS, 3 * COLUMNS * ROWS
FEATURES, DIRECTION_INPUTS, WIDTH, OUTPUTS = 8, 16, 32, 3
BATCH = (256, 192)
PICTURE = (1920, 1080)
BATCHES = 8
DEVICE = "cpu"  # main may change it


def corners_and_edges(triangle):
    """Vertices of the corners, and the edges opposite to them, of each triangle: [n, 3] both."""
    quad, upper = triangle // 2, triangle % 2
    row, column = quad // COLUMNS, quad % COLUMNS
    right, above = (column + 1) % COLUMNS, (row + 1) % ROWS
    a, b = row * COLUMNS + column, row * COLUMNS + right
    c, d = above * COLUMNS + right, above * COLUMNS + column
    # The edges that begin at vertex v: to the right 3v, upwards 3v+1, the diagonal 3v+2.
    lower_corners, upper_corners = np.stack([a, b, c], 1), np.stack([a, c, d], 1)
    lower_edges = np.stack([3 * b + 1, 3 * a + 2, 3 * a], 1)
    upper_edges = np.stack([3 * d, 3 * a + 1, 3 * a + 2], 1)
    pick = (upper == 1)[:, None]
    return np.where(pick, upper_corners, lower_corners), np.where(pick, upper_edges, lower_edges)


def topology():
    """The nodes of each triangle: of its corners and of the middles of its edges at R = 2, and of its corners at R = 1."""
    corners, edges = corners_and_edges(np.arange(2 * COLUMNS * ROWS))
    return torch.from_numpy(np.concatenate([corners, VERTICES + edges, VERTICES + EDGES + corners], 1)).to(DEVICE)


def nodes_and_weights(table, triangle, barycentrics):
    """[2n, 3], point by point: mesh colours at R = 2 on vertices and middles of edges, and at R = 1 on vertices."""
    words = table.index_select(0, triangle)
    b1, b2 = barycentrics.unbind(1)
    weights1 = torch.stack([1 - b1 - b2, b1, b2], 1)
    scaled = 2 * weights1
    whole = scaled.floor().clamp_(max=1)
    rest = scaled - whole
    corner = whole > 0
    inside = ~corner.any(1, keepdim=True)
    nodes = []
    for k in range(3):
        m, n = (k + 1) % 3, (k + 2) % 3
        # Near a corner: the middle of the edge from it to k, which is opposite to the third corner. Inside: that of edge k.
        middle = torch.where(corner[:, m], words[:, 3 + n], torch.where(corner[:, n], words[:, 3 + m], words[:, 3 + k]))
        nodes.append(torch.where(corner[:, k], words[:, k], middle))
    weights2 = torch.where(inside, 1 - rest, rest)
    return (torch.cat([torch.stack(nodes, 1), words[:, 6:]], 1).view(-1, 3),
            torch.cat([weights2, weights1], 1).view(-1, 3))


def one_blob(direction, bins=8):
    """Theta / pi and phi / 2 pi, a quartic kernel over `bins` each."""
    theta = torch.arccos(direction[:, 2].clamp(-1, 1)) / math.pi
    phi = (torch.atan2(direction[:, 1], direction[:, 0]) / (2 * math.pi)).remainder(1)
    centres = (torch.arange(bins, device=DEVICE) + 0.5) / bins

    def integral(x):
        x = x.clamp(-1, 1)
        z = x * x
        return x * (1 + z * (0.2 * z - 2 / 3)) * (15 / 16)

    distance = torch.stack([centres - theta[:, None], centres - phi[:, None]], 1)
    distance[:, 1] -= distance[:, 1].round()
    distance *= bins
    return (integral(distance + 0.5) - integral(distance - 0.5)).view(-1, 2 * bins)


def points(table, order, size, patch):
    """Points as in bench/neural_fixture: pixels, two per quad in each direction, or random places."""
    width, height = size
    count = width * height
    random = np.random.default_rng(1000 + patch)
    if order == "coherent":
        y, x = np.divmod(np.arange(count), width)
        quad = (y // 2 + 61 * patch) % ROWS * COLUMNS + (x // 2 + 137 * patch) % COLUMNS
        u, v = (x % 2 + random.random(count)) / 2, (y % 2 + random.random(count)) / 2
        lower = u >= v
        triangle = 2 * quad + ~lower
        b1, b2 = np.where(lower, u - v, u), np.where(lower, v, v - u)
        direction = np.stack([x / 1000 - 0.5, y / 1000 - 0.5, np.ones(count)], 1)
    else:
        triangle = random.integers(0, 2 * COLUMNS * ROWS, count)
        b1, b2 = random.random(count), random.random(count)
        b1, b2 = np.where(b1 + b2 > 1, 1 - b1, b1), np.where(b1 + b2 > 1, 1 - b2, b2)
        direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    made = {"triangle": torch.from_numpy(triangle),
            "barycentrics": torch.from_numpy(np.stack([b1, b2], 1).astype(np.float32)),
            "unit": torch.from_numpy(direction.astype(np.float32)),
            "targets": torch.from_numpy(random.random((count, OUTPUTS), dtype=np.float32))}
    made = {name: tensor.to(DEVICE) for name, tensor in made.items()}
    nodes, weights = nodes_and_weights(table, made["triangle"], made["barycentrics"])
    return {**made, "nodes": nodes, "weights": weights, "direction": one_blob(made["unit"])}


class AdamByHand:
    """Computes the same as SparseAdam, with gathers and scatters of rows instead of additions of sparse tensors."""

    def __init__(self, parameter, lr, betas, eps):
        self.parameter, self.lr, self.betas, self.eps = parameter, lr, betas, eps
        self.m, self.v, self.t = torch.zeros_like(parameter), torch.zeros_like(parameter), 0

    def zero_grad(self, set_to_none):
        del set_to_none
        self.parameter.grad = None

    @torch.no_grad()
    def step(self):
        self.t += 1
        gradient = self.parameter.grad.coalesce()
        rows, g = gradient.indices()[0], gradient.values()
        m = self.m.index_select(0, rows).lerp_(g, 1 - self.betas[0])
        v = self.v.index_select(0, rows).mul_(self.betas[1]).addcmul_(g, g, value=1 - self.betas[1])
        self.m.index_copy_(0, rows, m)
        self.v.index_copy_(0, rows, v)
        rate = self.lr * math.sqrt(1 - self.betas[1]**self.t) / (1 - self.betas[0]**self.t)
        new = self.parameter.index_select(0, rows).addcdiv_(m, v.sqrt_().add_(self.eps), value=-rate)
        self.parameter.index_copy_(0, rows, new)


class Cache:
    def __init__(self, feature_adam=torch.optim.SparseAdam):
        torch.manual_seed(1)
        count = 2 * VERTICES + EDGES
        self.features = torch.empty(count, FEATURES, device=DEVICE).uniform_(-1e-4, 1e-4).requires_grad_()
        self.network = torch.nn.Sequential(
            torch.nn.Linear(2 * FEATURES + DIRECTION_INPUTS, WIDTH), torch.nn.LeakyReLU(0.01, inplace=True),
            torch.nn.Linear(WIDTH, WIDTH), torch.nn.LeakyReLU(0.01, inplace=True), torch.nn.Linear(WIDTH, OUTPUTS)).to(DEVICE)
        options = {"lr": 1e-2, "betas": (0.9, 0.99), "eps": 1e-15}
        features = [self.features] if feature_adam is torch.optim.SparseAdam else self.features
        self.optimizers = [feature_adam(features, **options),
                           torch.optim.Adam(self.network.parameters(), weight_decay=1e-6, **options)]
        self.luminance = torch.tensor([0.299, 0.587, 0.114], device=DEVICE)

    def encode(self, nodes, weights, direction, features):
        found = functional.embedding_bag(nodes, features, per_sample_weights=weights, mode="sum", sparse=True)
        return torch.cat([found.view(-1, 2 * FEATURES), direction], 1)

    def step(self, batch):
        for optimizer in self.optimizers:
            optimizer.zero_grad(set_to_none=True)
        y = self.network(self.encode(batch["nodes"], batch["weights"], batch["direction"], self.features))
        scale = 1 / ((y.detach() @ self.luminance) ** 2 + 0.01)
        loss = ((y - batch["targets"]) ** 2 * scale[:, None]).mean()
        loss.backward()
        for optimizer in self.optimizers:
            optimizer.step()
        return loss

    @torch.inference_mode()
    def query(self, batch, out, network, dtype, chunk, table=None):
        """With the table it also does the lookups and the direction's encoding, as our queries do."""
        features = self.features.detach()
        for begin in range(0, len(out), chunk):
            end = begin + chunk
            if table is None:
                nodes, weights = batch["nodes"][2 * begin:2 * end], batch["weights"][2 * begin:2 * end]
                direction = batch["direction"][begin:end]
            else:
                nodes, weights = nodes_and_weights(table, batch["triangle"][begin:end], batch["barycentrics"][begin:end])
                direction = one_blob(batch["unit"][begin:end])
            x = self.encode(nodes, weights, direction, features)
            out[begin:end] = network(x.to(dtype)).clamp_(min=0)


def wait():
    if DEVICE != "cpu":
        torch.cuda.synchronize()


def median_ms(run, repetitions, warm_up):
    for i in range(warm_up):
        run(i)
    times = []
    for i in range(repetitions):
        wait()
        start = time.perf_counter()
        run(i)
        wait()
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times)


def check(table):
    """Checks the precomputed lookups: they must return an affine field over a triangle exactly."""
    triangle = np.repeat(np.arange(0, 2000, 7), 50)
    random = np.random.default_rng(1)
    b1, b2 = random.random((2, len(triangle)))
    b1, b2 = np.where(b1 + b2 > 1, 1 - b1, b1), np.where(b1 + b2 > 1, 1 - b2, b2)
    corners, edges = corners_and_edges(triangle)
    nodes, weights = (found.view(-1, 6).cpu().numpy() for found in nodes_and_weights(
        table, torch.from_numpy(triangle).to(DEVICE), torch.from_numpy(np.stack([b1, b2], 1)).to(DEVICE)))
    field = np.full((len(triangle), 3), [1.0, 5.0, -2.0])
    middles = (field.sum(1, keepdims=True) - field) / 2
    value = np.zeros(len(triangle))
    for k in range(3):
        for number, at in ((corners, field), (VERTICES + edges, middles)):
            for m in range(3):
                value += np.where(nodes[:, k] == number[:, m], weights[:, k] * at[:, m], 0)
    expected = (1 - b1 - b2) * 1.0 + b1 * 5.0 + b2 * -2.0
    assert np.allclose(value, expected) and np.allclose(weights.sum(1), 2), "the lookups are wrong"
    blobs = one_blob(torch.from_numpy(random.normal(size=(1000, 3)) / 9 + [0, 1, 0]).to(DEVICE))
    assert np.allclose(blobs[:, 8:].sum(1).cpu(), 1), "the direction's encoding is wrong"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--queries", type=int, required=True)
    parser.add_argument("--chunk", type=int, required=True)
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    options = parser.parse_args()
    global DEVICE  # pylint: disable=global-statement
    DEVICE = options.device
    table = topology()
    check(table)
    torch.set_num_threads(options.threads)
    result = {}
    for order in ("coherent", "random"):
        batches = [points(table, order, BATCH, patch) for patch in range(BATCHES)]
        losses = []
        for name, feature_adam in (("train_by_hand", AdamByHand), ("train", torch.optim.SparseAdam)):
            cache = Cache(feature_adam)
            first = cache.step(batches[0]).item()
            result[f"{name}/{order}"] = median_ms(lambda i: cache.step(batches[i % BATCHES]), options.steps, BATCHES)
            losses.append(cache.step(batches[0]).item())
            assert losses[-1] < first, f"PyTorch does not learn: loss {first} to {losses[-1]}"
        assert math.isclose(*losses, rel_tol=0.02), f"both ways to update are not the same: losses {losses}"
        picture = points(table, order, PICTURE, 0)
        out = torch.empty(PICTURE[0] * PICTURE[1], OUTPUTS, device=DEVICE)
        half = torch.nn.Sequential(*[
            torch.nn.LeakyReLU(0.01, inplace=True) if not hasattr(layer, "weight") else
            torch.nn.Linear(layer.in_features, layer.out_features) for layer in cache.network])
        half.load_state_dict(cache.network.state_dict())
        half.bfloat16().to(DEVICE)
        for name, network, dtype in (("fp32", cache.network, torch.float32), ("bf16", half, torch.bfloat16)):
            result[f"query/{order}/{name}"] = median_ms(
                lambda _: cache.query(picture, out, network, dtype, options.chunk), options.queries, 1)
            answers = out.clone()
            result[f"query_all/{order}/{name}"] = median_ms(
                lambda _: cache.query(picture, out, network, dtype, options.chunk, table), options.queries, 1)
            assert torch.allclose(out, answers, atol=1e-4 if name == "fp32" else 3e-2), "both kinds of query differ"
    with open("/proc/self/maps", encoding="utf-8") as file:
        result["openblas"] = "openblas" in file.read()
    result["torch"] = torch.__version__
    if DEVICE != "cpu":
        result["device"] = torch.cuda.get_device_name()
    print(json.dumps(result))


main()
