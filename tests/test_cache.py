"""What is kept between runs is found again, never taken for something else, and never missed where it cannot be."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from codegen import cache

LONG_AGO = time.time() - 400 * 24 * 3600.0


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path


def test_a_thing_is_made_once_for_each_description(home: Path) -> None:
    made: list[str] = []

    def make(word: str) -> str:
        made.append(word)
        return word * 2

    found = [cache.kept(("word", word), lambda word=word: make(word)) for word in ("a", "b", "a")]  # type: ignore[misc]
    assert (found, made) == (["aa", "bb", "aa"], ["a", "b"])


def test_what_is_kept_is_told_before_it_is_asked_for(home: Path) -> None:
    assert not cache.is_kept("answer")
    cache.kept("answer", lambda: 42)
    assert cache.is_kept("answer") and not cache.is_kept("another answer")


def test_a_file_is_made_once_and_has_the_content_it_was_made_with(home: Path) -> None:
    paths = [cache.kept_file("file", ".so", lambda: b"content") for _ in range(2)]
    assert paths[0] == paths[1] and paths[0].read_bytes() == b"content"
    assert paths[0].is_relative_to(home / "jointgen")


def test_a_failure_is_not_kept(home: Path) -> None:
    with pytest.raises(ZeroDivisionError):
        cache.kept("quotient", lambda: 1 / 0)
    assert cache.kept("quotient", lambda: 1.0) == 1.0


def test_without_a_place_to_write_things_are_made_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert cache.kept("anything", lambda: 3) == 3
    assert cache.kept_file("anything", ".txt", lambda: b"3").read_bytes() == b"3"


def test_what_other_sources_made_is_forgotten_when_nobody_used_it_for_long(home: Path) -> None:
    old, fresh = home / "jointgen/old", home / "jointgen/fresh"
    for folder in (old, fresh):
        folder.mkdir(parents=True)
        (folder / "program.pickle").write_bytes(b"")
    os.utime(old, (LONG_AGO, LONG_AGO))
    assert cache.cache_folder().parent == home / "jointgen"
    assert (old.exists(), fresh.exists()) == (False, True)


def test_what_a_crash_cut_short_is_made_again(home: Path) -> None:
    assert cache.kept("whole", lambda: [1, 2]) == [1, 2]
    file = cache.kept_file("whole", ".so", lambda: b"content")
    for path in cache.cache_folder().iterdir():
        path.write_bytes(b"")
    assert cache.kept("whole", lambda: [3]) == [3]
    assert cache.kept_file("whole", ".so", lambda: b"other") == file and file.read_bytes() == b"other"


def test_where_there_is_no_room_things_are_made_all_the_same(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put = cache._put

    def full(path: Path, content: bytes) -> None:
        if path.is_relative_to(home):
            raise OSError("no space left on device")
        put(path, content)

    monkeypatch.setattr(cache, "_put", full)
    assert cache.kept("anything", lambda: 3) == 3
    assert cache.kept_file("anything", ".txt", lambda: b"3").read_bytes() == b"3"
