// What the theme leaves to do for keyboards and screen readers: names, and a way into whatever scrolls.
document$.subscribe(() => {
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
  for (const area of document.querySelectorAll(".md-search__scrollwrap, .md-sidebar__scrollwrap, .md-typeset__scrollwrap, .md-typeset pre > code, .snug-tabs pre")) {
    area.tabIndex = 0;
  }
});
