/** Tabs, which arrow keys change. */

/**
 * @param {HTMLElement} list role tablist
 * @param {(name: string) => void} chosen called with the id of the panel
 */
export function tabs(list, chosen) {
  const all = /** @type {HTMLElement[]} */ ([...list.querySelectorAll('[role="tab"]')]);
  const select = (tab) => {
    for (const one of all) {
      const is = one === tab;
      one.setAttribute('aria-selected', String(is));
      one.tabIndex = is ? 0 : -1;
      document.getElementById(one.getAttribute('aria-controls')).hidden = !is;
    }
    chosen(tab.getAttribute('aria-controls'));
  };
  for (const tab of all) tab.addEventListener('click', () => select(tab));
  list.addEventListener('keydown', (event) => {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const next = all[(all.indexOf(document.activeElement) + way + all.length) % all.length];
    next.focus();
    select(next);
  });
}
