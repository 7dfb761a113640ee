// What the theme leaves to do for keyboards and screen readers: names, and a way into whatever scrolls.
document$.subscribe(() => {
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
  for (const area of document.querySelectorAll(".md-search__scrollwrap, .md-sidebar__scrollwrap, .md-typeset__scrollwrap, .md-typeset pre > code, .snug-tabs pre")) {
    area.tabIndex = 0;
  }
  // An option is not torn apart at its hyphens.
  for (const code of document.querySelectorAll(".md-typeset :not(pre) > code")) {
    if (code.textContent.length <= 18) code.classList.add("snug-short");
  }
});
