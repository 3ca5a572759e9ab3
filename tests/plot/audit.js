// What a reader with weak eyes, a keyboard or a screen reader would miss on the page that is open.
() => {
  const faults = [];
  const told = element => `${element.tagName.toLowerCase()} "${(element.textContent || "").trim().slice(0, 40)}"`;
  const numbers = colour => {
    const found = colour.match(/[\d.]+/g).map(Number);
    return colour.startsWith("color(srgb") ? found.map((one, k) => k < 3 ? 255 * one : one) : found;
  };
  const luminance = ([r, g, b]) => {
    const part = x => (x /= 255) <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b);
  };
  const seen = element => element.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  const ground = element => {
    for (let one = element; one; one = one.parentElement) {
      const colour = numbers(getComputedStyle(one).backgroundColor);
      if (colour.length < 4 || colour[3] > 0.5) return colour;
    }
    return matchMedia("(prefers-color-scheme: dark)").matches ? [18, 18, 18] : [255, 255, 255];
  };
  for (const element of document.body.querySelectorAll("*")) {
    const own = [...element.childNodes].some(one => one.nodeType === 3 && one.data.trim());
    if (!own || !seen(element) || element.closest("svg, script, style, noscript, :disabled")) continue;
    const style = getComputedStyle(element), size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.6 && style.fontWeight >= 700);
    const [high, low] = [luminance(numbers(style.color)), luminance(ground(element))].sort((a, b) => b - a);
    const contrast = (high + 0.05) / (low + 0.05);
    if (contrast < (large ? 3 : 4.5)) faults.push(`contrast ${contrast.toFixed(2)}: ${told(element)}`);
    if (size < 9) faults.push(`letters of ${size} px: ${told(element)}`);
  }
  for (const image of document.images) if (!image.alt.trim()) faults.push("a picture without alt");
  for (const drawing of document.querySelectorAll("svg, canvas"))
    if (!drawing.ariaLabel && !drawing.ariaHidden && !drawing.closest("[aria-hidden], [aria-label]"))
      faults.push(`a drawing without a name: ${told(drawing)}`);
  for (const control of document.querySelectorAll("button, input, select, textarea, summary, a[href]")) {
    const name = control.ariaLabel || control.textContent.trim() || control.labels?.length || control.title
      || control.querySelector("img")?.alt;
    if (!name) faults.push(`without a name: ${control.outerHTML.slice(0, 80)}`);
    if (control.tabIndex < 0 && !control.disabled) faults.push(`no key reaches ${told(control)}`);
  }
  const ids = [...document.querySelectorAll("[id]")].map(one => one.id);
  for (const id of new Set(ids)) if (ids.indexOf(id) !== ids.lastIndexOf(id)) faults.push(`twice: id ${id}`);
  for (const link of document.querySelectorAll('a[href^="#"]'))
    if (link.hash.length > 1 && !document.getElementById(decodeURIComponent(link.hash.slice(1))))
      faults.push(`leads nowhere: ${link.hash}`);
  for (const table of document.querySelectorAll("table"))
    if (!table.querySelector("th")) faults.push(`a table without headings: ${told(table)}`);
  const levels = [...document.querySelectorAll("h1, h2, h3, h4")].map(one => Number(one.tagName[1]));
  if (levels.filter(one => one === 1).length !== 1) faults.push("not one h1");
  levels.forEach((one, k) => { if (k && one > levels[k - 1] + 1) faults.push(`h${one} below h${levels[k - 1]}`); });
  if (!document.documentElement.lang) faults.push("no language");
  if (!document.title.trim()) faults.push("no title");
  if (!document.querySelector('meta[name="viewport"]')) faults.push("no viewport");
  if (document.documentElement.scrollWidth > innerWidth) faults.push(`wider than the window: ${document.documentElement.scrollWidth}`);
  return faults;
}
