#nullable enable
namespace HaptoFlow
{
    /// <summary>Where the package's documentation lies on the web. The one home of the address, which package.json
    /// repeats for the Package Manager.</summary>
    internal static class HelpPages
    {
        public const string Home = "https://haptoflow.com/documentation/";

        /// <summary>The page with a section for each component; the section's anchor goes behind it.</summary>
        public const string Components = Home + "components.html#";
    }
}
