"""Lattice of the ground that a plan shows to be free, with the stairs between its storeys."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from base_station.routing.interface import Floats, Indices
from base_station.site.floor_grid import FloorGrid

MOST_NODES = 400_000  # of all floors; in a larger plan only trails give a way
UNWALKED = 1.3  # cost of ground that only the plan knows: a door may be locked (ours)
OPEN_GROUND_M = 100.0  # about a plan: so far out the straight way to it is open (ours)
STAIRS_SLOPE = 2.0  # way on stairs for each metre of rise: they are about 30 degrees steep


class PlanLattice(NamedTuple):
    """Nodes and edges, floor by floor."""

    places_m: Floats  # (n, 2)
    floors: Indices  # (n,)
    edges: Indices  # (m, 2), of nodes
    costs_m: Floats  # (m,), for each its length, and more on level ground not walked so far
    # By floor: the node of each point of the lattice, -1 where a wall is.
    nodes: dict[int, Indices]
    grid: FloorGrid | None

    @property
    def is_empty(self) -> bool:
        return not self.nodes

    def edge_node(self, floor: int, place_m: Floats) -> int:
        """Node at the edge of the plan nearest to a position (2,) beyond it; -1 if there is
        none.
        """
        if self.grid is None or floor not in self.nodes:
            return -1
        nodes = self.nodes[floor]
        (row,), (column,) = self.grid.lattice_points(place_m[None])
        within = (0 <= row < nodes.shape[0]) and (0 <= column < nodes.shape[1])
        if within:
            return -1
        last_row, last_column = nodes.shape[0] - 1, nodes.shape[1] - 1
        return int(nodes[min(max(row, 0), last_row), min(max(column, 0), last_column)])

    def node_at(self, floor: int, places_m: Floats) -> Indices:
        """Node (k,) nearest to each position (k, 2); -1 beside the plan, or in a wall."""
        if self.grid is None or floor not in self.nodes:
            return np.full(len(places_m), -1, dtype=np.int64)
        nodes = self.nodes[floor]
        rows, columns = self.grid.lattice_points(places_m)
        within = (rows >= 0) & (rows < nodes.shape[0])
        within &= (columns >= 0) & (columns < nodes.shape[1])
        found = np.full(len(places_m), -1, dtype=np.int64)
        found[within] = nodes[rows[within], columns[within]]
        return found


NO_LATTICE = PlanLattice(
    np.empty((0, 2)), np.empty(0, np.int64), np.empty((0, 2), np.int64), np.empty(0), {}, None
)


def plan_lattice(grid: FloorGrid | None) -> PlanLattice:
    """Lattice of all floors whose walls the plan shows; an empty one if there are none."""
    if grid is None:
        return NO_LATTICE
    lattices = {floor: grid.free_lattice(floor) for floor in grid.floors}
    if sum(int(np.count_nonzero(one.is_free)) for one in lattices.values()) > MOST_NODES:
        return NO_LATTICE
    nodes: dict[int, Indices] = {}
    places, floors, edges, costs = [], [], [], []
    count = 0
    for floor, lattice in lattices.items():
        numbers = np.full(lattice.is_free.shape, -1, dtype=np.int64)
        free = int(np.count_nonzero(lattice.is_free))
        numbers[lattice.is_free] = np.arange(count, count + free)
        nodes[floor] = numbers
        places.append(lattice.places_m[lattice.is_free])
        floors.append(np.full(free, floor))
        for begin, end, length_m in lattice.steps:
            edges.append(np.column_stack([numbers[begin], numbers[end]]))
            costs.append(np.full(len(edges[-1]), UNWALKED * length_m))
        count += free
    storeys = [storey for storey in grid.plan.storeys if storey.floor in nodes]
    for lower, upper in pairwise(storeys):
        climbs = _climbs(grid, nodes, lower.floor, upper.floor)
        edges.append(climbs)
        rise_m = abs(upper.down_m - lower.down_m)
        costs.append(np.full(len(climbs), STAIRS_SLOPE * rise_m))
    return PlanLattice(
        np.concatenate(places),
        np.concatenate(floors),
        np.concatenate(edges),
        np.concatenate(costs),
        nodes,
        grid,
    )


def _climbs(grid: FloorGrid, nodes: dict[int, Indices], lower: int, upper: int) -> Indices:
    """Edges (k, 2) where stairs of both storeys lie over each other, or where one has stairs."""
    both = [floor for floor in (lower, upper) if grid.has_stairs(floor)]
    if not both:
        return np.empty((0, 2), dtype=np.int64)
    on_stairs = np.logical_and.reduce([grid.lattice_stairs(floor) for floor in both])
    on_stairs = on_stairs & (nodes[lower] >= 0) & (nodes[upper] >= 0)
    return np.column_stack([nodes[lower][on_stairs], nodes[upper][on_stairs]])
