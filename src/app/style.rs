//! Spacing and colours of the window.

/// Sets the spacing of both themes, and replaces those of egui's colours that are too pale.
pub(super) fn style(context: &egui::Context) {
    // The table of commands has the keys for zoom.
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.slider_width = 80.0;
        // A slider with its number is as wide as a combo box.
        style.spacing.interact_size.x = 58.0;
        style.spacing.combo_width = 146.0;
        // A scroll bar lies beside what it scrolls, not over it, and shows from the start that there is more.
        style.spacing.scroll.floating_allocated_width = style.spacing.scroll.bar_width;
        style.spacing.scroll.dormant_handle_opacity = 0.5;
        style.interaction.tooltip_delay = 0.4;
    });
    // egui's own colours are too dim on black, and too glaring for sentences.
    context.style_mut_of(egui::Theme::Dark, |style| {
        style.visuals.error_fg_color = egui::Color32::from_rgb(255, 110, 95);
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(135));
    });
    // egui's own colours are too pale on white: boxes and tracks get an outline, and warnings are darker.
    context.style_mut_of(egui::Theme::Light, |style| {
        style.visuals.warn_fg_color = egui::Color32::from_rgb(150, 75, 0);
        style.visuals.error_fg_color = egui::Color32::from_rgb(180, 20, 10);
        style.visuals.widgets.inactive.bg_stroke = egui::Stroke::new(1.0, egui::Color32::from_gray(165));
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(95));
    });
}
