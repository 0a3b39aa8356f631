using System;
using System.Globalization;
using System.Linq;
using System.Reflection;
using NUnit.Framework;

/// <summary>Every test runs in a language that writes differently: with a minus sign of its own (Swedish), another letter
/// i (Turkish), other marks in numbers and another calendar (Persian). A project has one of them; the variable
/// HAPTOFLOW_TEST_CULTURE names another. Without a namespace, so that it is set up before everything.</summary>
[SetUpFixture]
public sealed class TestCulture
{
    private static readonly string[] Names = { "sv-SE", "tr-TR", "fa-IR" };

    [OneTimeSetUp]
    public void Choose()
    {
        string project = Assembly.GetExecutingAssembly().GetName().Name!;
        string? named = Environment.GetEnvironmentVariable("HAPTOFLOW_TEST_CULTURE");
        string name = string.IsNullOrEmpty(named) ? Names[project.Sum(letter => letter) % Names.Length] : named;
        var culture = new CultureInfo(name);
        if (culture.NumberFormat.NumberDecimalSeparator == ".")
        {
            throw new InvalidOperationException(
                $"{name} writes numbers as every language does here: .NET lacks ICU (libicu), or runs without cultures");
        }
        CultureInfo.CurrentCulture = culture;
        CultureInfo.CurrentUICulture = culture;
        CultureInfo.DefaultThreadCurrentCulture = culture;
        CultureInfo.DefaultThreadCurrentUICulture = culture;
    }
}
