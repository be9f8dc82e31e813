"""The living page: a gas that is simulated in the browser, in one HTML file that loads nothing."""
