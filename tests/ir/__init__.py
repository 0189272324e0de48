"""Programs for tests, and the tests of the intermediate representation."""
