"""The picture of the ground about the site."""

from __future__ import annotations

import msgspec
from sqlalchemy import delete, select

from base_station.site.base_map import Corners
from base_station.storage.db.database import Database
from base_station.storage.db.models import BaseMap


class BaseMaps:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database) -> None:
        self._store = store

    def put(self, image: bytes, image_hash: str, corners: Corners) -> None:
        """In the place of the one before."""
        with self._store.write() as session:
            session.execute(delete(BaseMap))
            session.add(
                BaseMap(image_hash=image_hash, image=image, corners=msgspec.json.encode(corners))
            )

    def remove(self) -> bool:
        """False where there is none."""
        with self._store.write() as session:
            there = session.scalars(select(BaseMap.image_hash)).first() is not None
            session.execute(delete(BaseMap))
            return there

    def corners(self) -> tuple[str, Corners] | None:
        """With the picture's hash; None where there is none."""
        with self._store.read() as session:
            row = session.execute(select(BaseMap.image_hash, BaseMap.corners)).first()
            return None if row is None else (row[0], msgspec.json.decode(row[1], type=Corners))

    def image(self, image_hash: str) -> bytes | None:
        with self._store.read() as session:
            return session.scalars(
                select(BaseMap.image).where(BaseMap.image_hash == image_hash)
            ).first()
