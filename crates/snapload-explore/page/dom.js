// The page's elements by their ids.

/**
 * @param {string} id
 * @returns {any} Which kind of element it is is known where it is asked for.
 */
export const $ = (id) => document.getElementById(id);
