"""Threads of linear algebra within a diagnosis."""

import importlib
from types import SimpleNamespace

import scipy.linalg  # noqa: F401
from threadpoolctl import threadpool_info, threadpool_limits

from geomdrap.criticism.threads import one_blas_thread

module = importlib.import_module("geomdrap.criticism.diagnose")


def blas_threads():
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


def test_blas_has_one_thread_within_and_as_many_as_before_afterwards():
    with threadpool_limits(limits=2, user_api="blas"):
        assert blas_threads() == {2}
        with one_blas_thread():
            assert blas_threads() == {1}
        assert blas_threads() == {2}


def test_a_diagnosis_searches_with_one_blas_thread(monkeypatch):
    seen = []
    monkeypatch.setattr(module, "prepare", lambda *_: (None, ()))
    monkeypatch.setattr(module, "search", lambda *_: seen.append(blas_threads()) or [SimpleNamespace(closest=None)])
    monkeypatch.setattr(module, "cleaned", lambda *_: seen.append(blas_threads()))
    monkeypatch.setattr(module, "conclude", lambda *_: None)
    with threadpool_limits(limits=2, user_api="blas"):
        module.diagnose(None, None)
    assert seen == [{1}, {1}]
