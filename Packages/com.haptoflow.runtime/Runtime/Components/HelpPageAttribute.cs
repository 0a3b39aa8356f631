#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Names the page that the help button of a component or asset opens. Unlike Unity's own attribute it takes
    /// a page's name, and finds the address when the button is drawn.</summary>
    [AttributeUsage(AttributeTargets.Class, AllowMultiple = false)]
    internal sealed class HelpPageAttribute : HelpURLAttribute
    {
        /// <param name="page">As for <see cref="HelpPages.AddressOf(string)"/>.</param>
        public HelpPageAttribute(string page)
            : base(HelpPages.AddressOf(page)) => Page = page;

        /// <summary>The page, with the section's anchor.</summary>
        public string Page { get; }
    }
}
