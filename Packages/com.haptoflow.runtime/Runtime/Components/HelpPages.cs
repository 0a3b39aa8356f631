#nullable enable
namespace HaptoFlow
{
    /// <summary>Addresses of the package's documentation on the web. package.json repeats the address for the Package
    /// Manager.</summary>
    internal static class HelpPages
    {
        public const string Home = "https://haptoflow.com/documentation/";

        /// <summary>The page with a section for each component; append the section's anchor.</summary>
        public const string Components = Home + "components.html#";
    }
}
